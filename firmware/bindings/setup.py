"""Only what pyproject.toml cannot say: which extension to compile."""

from setuptools import setup

setup(cffi_modules=["build_dockcore.py:ffi"])
