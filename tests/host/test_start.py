"""What is loaded before there is work to do: little, so that the command line answers at once."""

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from patience import PATIENCE_S

import chromadock
from chromadock import choices, detector

HEAVY = (
    *("numpy", "cv2", "PIL", "yaml", "rich", "matplotlib", "serial", "pymavlink", "cffi"),
    *("jerlov", "dask", "distributed", "polars", "jinja2", "mcap", "rosbags"),
    *("chromadock._native", "chromadock.dialect", "chromadock.method_tables"),
    "chromadock_firmware",
)
"""Modules that take tens of milliseconds or more."""

ALL_HELPS = """
import sys
import typer
from chromadock.cli import app

def names(command, before=()):
    yield before
    for name, below in getattr(command, "commands", {}).items():
        yield from names(below, (*before, name))

for name in names(typer.main.get_command(app)):
    app([*name, "--help"], standalone_mode=False)
"""


def loaded(program):
    """Names of the modules that a program has loaded at its end, and what it printed."""
    done = subprocess.run(
        [sys.executable, "-c", f"{program}\nimport sys\nprint(*sys.modules, file=sys.stderr)"],
        capture_output=True,
        text=True,
        check=True,
        timeout=PATIENCE_S,
    )
    return set(done.stderr.split()), done.stdout


def test_the_package_loads_nothing_but_the_standard_library():
    modules, _ = loaded("import chromadock")
    assert "chromadock" in modules
    assert not modules & {*HEAVY, "pydantic", "typer"}
    assert not [m for m in modules if m.startswith("chromadock.")]


def test_no_help_loads_what_only_a_run_needs():
    modules, helps = loaded(ALL_HELPS)
    assert helps.count("Usage: ") > 15
    assert "chromadock.cli.dock_flash" in modules
    assert not modules & set(HEAVY)


@pytest.mark.parametrize("name", chromadock.__all__)
def test_a_public_name_is_there_when_it_is_asked_for(name):
    assert getattr(chromadock, name).__name__ == name
    assert name in dir(chromadock)


def test_an_unknown_name_is_refused_as_in_any_module():
    with pytest.raises(AttributeError, match="module 'chromadock' has no attribute 'Dector'"):
        chromadock.Dector  # noqa: B018


def test_type_checkers_see_the_same_names_as_python():
    source = ast.parse(Path(chromadock.__file__).read_text())
    imports = [node for node in ast.walk(source) if isinstance(node, ast.ImportFrom)]
    homes = {
        alias.name: node.module
        for node in imports
        for alias in node.names
        if node.module.startswith("chromadock.")
    }
    assert sorted(homes) == sorted(chromadock.__all__)
    for name, home in homes.items():
        assert getattr(import_module(home), name) is getattr(chromadock, name)


def test_every_method_that_is_offered_is_there():
    dock = chromadock.DockGeometry.default()
    for method in choices.METHODS:
        detector.Detector(None, dock, method=method)
