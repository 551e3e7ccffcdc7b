"""Only what pyproject.toml cannot say: a module is generated and an extension compiled."""

from __future__ import annotations

import sys
from pathlib import Path

from setuptools import Command, setup
from setuptools.command.build import build

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "shared"))

import mavlink  # noqa: E402 - found by the line above


class BuildDialect(Command):
    """Write chromadock/dialect.py into the source folder, for editable installations too.

    A step of its own: in an editable installation setuptools turns errors of a changed
    ``build_py`` into warnings.
    """

    description = "write the MAVLink dialect's module"
    user_options: list[tuple[str, str | None, str]] = []  # noqa: RUF012 - setuptools' own way
    # Set by setuptools.
    editable_mode = False

    def initialize_options(self) -> None:
        """Nothing to set."""

    def finalize_options(self) -> None:
        """Nothing to check."""

    def run(self) -> None:
        """Write the module, unless it is up to date."""
        try:
            mavlink.generate_python(HERE / "chromadock" / "dialect.py")
        except mavlink.MavlinkError as error:
            sys.exit(f"error: {error}")

    def get_source_files(self) -> list[str]:
        """Give nothing: the definition lies outside this package."""
        return []

    def get_outputs(self) -> list[str]:
        """Give nothing: the module is build_py's from here on."""
        return []

    def get_output_mapping(self) -> dict[str, str]:
        """Give nothing, as above."""
        return {}


class Build(build):
    """The build with that step before the others."""

    sub_commands = [("build_dialect", None), *build.sub_commands]  # noqa: RUF012 - setuptools' own way


setup(
    cmdclass={"build": Build, "build_dialect": BuildDialect},
    cffi_modules=["build_native.py:ffi"],
)
