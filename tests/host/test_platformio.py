"""What PlatformIO does with the project as a user has it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest
from patience import PATIENCE_S

ROOT = Path(__file__).resolve().parents[2]
PIO = Path(sys.executable).with_name("pio")

needs_pio = pytest.mark.skipif(not PIO.exists(), reason="PlatformIO is not installed")


def pio(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [PIO, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )


@pytest.fixture(scope="module")
def configuration() -> dict[str, dict[str, object]]:
    done = pio("project", "config", "--json-output")
    return {name: dict(options) for name, options in json.loads(done.stdout)}


@needs_pio
def test_a_bare_run_builds_for_the_board(configuration):
    assert configuration["platformio"]["default_envs"] == ["esp32cam"]
    assert configuration["env:esp32cam"]["platform"] == "espressif32@6.13.0"


@needs_pio
def test_the_monitor_has_the_speed_of_the_boot_log_and_lets_go_of_both_lines(configuration):
    for core in ("env:esp32cam", "env:esp32cam_core3"):
        assert configuration[core]["monitor_speed"] == 115200
        assert not configuration[core]["monitor_rts"]
        assert not configuration[core]["monitor_dtr"]


@needs_pio
def test_no_suite_is_built_for_the_board():
    done = pio("test", "-e", "esp32cam", "--list-tests")
    assert done.returncode == 0
    suites = [line.split() for line in done.stdout.splitlines() if " test_" in line]
    assert suites
    assert all(status == "SKIPPED" for *_, status in suites)


@needs_pio
def test_a_build_of_the_tests_environment_says_what_to_run():
    done = pio("run", "-e", "native")
    assert done.returncode != 0
    assert "error: [env:native] has tests and no firmware: run `pio test -e native`" in done.stderr


def test_ci_builds_every_environment_of_a_board(configuration):
    boards = {name.removeprefix("env:") for name in configuration if "env:esp32cam" in name}
    workflow = (ROOT / ".github" / "workflows" / "ci.yml").read_text()
    assert f"environment: [{', '.join(sorted(boards))}]" in workflow


# SCons as tools/pio_mavlink.py sees it, in a Python of its own.
SCONS = """
import sys
class Environment:
    def subst(self, text):
        return {"$PROJECT_DIR": sys.argv[1], "$PYTHONEXE": sys.executable}[text]
    def Append(self, **flags):
        print("headers", flags["CPPPATH"][0])
def DefaultEnvironment():
    return Environment()
"""

# Installs what the tests' own Python has, and writes down how it was called.
UV = f"""#!{sys.executable}
import pathlib, sys, subprocess, pymavlink
*start, python = sys.argv[1:5]
assert start == ["pip", "install", "--python"], sys.argv
where = 'import sysconfig; print(sysconfig.get_paths()["purelib"])'
site = subprocess.check_output([python, "-c", where], text=True).strip()
for part in pathlib.Path(pymavlink.__file__).parents[1].iterdir():
    pathlib.Path(site, part.name).symlink_to(part)
pathlib.Path(sys.argv[0]).with_name("called").write_text(" ".join(sys.argv[5:]))
"""


@pytest.fixture
def without_pip(tmp_path):
    """Runs tools/pio_mavlink.py in a Python without pip; its folders are returned."""
    venv.create(tmp_path / "venv", with_pip=False)
    python = tmp_path / "venv" / "bin" / "python"
    (tmp_path / "SCons").mkdir()
    (tmp_path / "SCons" / "Script.py").write_text(SCONS)
    project = tmp_path / "project"
    shutil.copytree(ROOT / "shared", project / "shared")
    (project / "tools").mkdir()
    shutil.copy(ROOT / "tools" / "constraints.txt", project / "tools")

    def run(path: str) -> subprocess.CompletedProcess[str]:
        # SCons puts a script's code into its own namespace, without running its file.
        script = str(ROOT / "tools" / "pio_mavlink.py")
        code = f"exec(compile(open({script!r}).read(), 'script', 'exec'))"
        environment = {**os.environ, "PATH": path, "PYTHONPATH": str(tmp_path)}
        command = [str(python), "-c", code, str(project)]
        return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)

    return run


def test_headers_are_made_where_platformio_s_python_has_no_pip_but_there_is_uv(
    without_pip, tmp_path
):
    (tmp_path / "bin").mkdir()
    uv = tmp_path / "bin" / "uv"
    uv.write_text(UV)
    uv.chmod(0o755)
    done = without_pip(str(tmp_path / "bin"))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "bin" / "called").read_text().split()[-1] == "pymavlink"
    assert (tmp_path / "project/build/mavlink/c/chromadock/mavlink.h").is_file()
    assert "headers" in done.stdout


def test_without_pip_and_uv_the_build_says_what_to_install(without_pip, tmp_path):
    done = without_pip(str(tmp_path / "nothing"))
    assert done.returncode != 0
    assert "neither pymavlink nor pip, and there is no uv: install pymavlink" in done.stderr
    assert "Traceback" not in done.stderr
