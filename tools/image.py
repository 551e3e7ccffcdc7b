"""What the BlueOS extension's image is made of, without Docker: .venv/bin/python tools/image.py.

The commands of its Dockerfile run here in two fresh environments, of this computer's processor;
then every package that it takes is sought as a wheel for arm64.  Needs the network.
"""

from __future__ import annotations

import fnmatch
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from dockerfile import copied, runs
from step import ROOT

from chromadock.toml_file import read_toml

DOCKERFILE = ROOT / "deploy" / "blueos" / "Dockerfile"
IGNORE = DOCKERFILE.with_name("Dockerfile.dockerignore")
SYSTEM = "apt-get "
"""What begins so changes the system, and is left out."""
# Wheels of glibc up to that of Debian bookworm, which the image is of.
ARM64 = [f"manylinux_2_{glibc}_aarch64" for glibc in range(17, 37)] + ["manylinux2014_aarch64"]
PYTHON = "3.11"
USE = """
import cv2, numpy, pathlib, subprocess, sys
from importlib import resources
assert resources.files("chromadock.output.page").joinpath("index.html").is_file()
cv2.imwrite("0.png", numpy.full((240, 320, 3), (140, 110, 30), numpy.uint8))
pathlib.Path("v.toml").write_text('[camera]\\nsource = "0.png"\\n')
outs = ["json:log.jsonl", "mcap:dive.mcap", "http:18644"]
command = ["chromadock", "run", "v.toml", *(x for out in outs for x in ("--out", out))]
sys.exit(subprocess.run(command, stdout=subprocess.DEVNULL).returncode)
"""


def context(folder: Path) -> None:
    """Copy what the Dockerfile copies, less what is ignored."""
    lines = IGNORE.read_text().splitlines()
    ignored = [line for line in lines if line and line[0] not in "#!" and line != "*"]

    def left_out(parent: str, names: list[str]) -> set[str]:
        paths = {name: str((Path(parent) / name).relative_to(ROOT)) for name in names}
        return {
            name
            for name, path in paths.items()
            if any(fnmatch.fnmatch(path, pattern.removeprefix("**/")) for pattern in ignored)
            or name == "__pycache__"
        }

    for source in copied(DOCKERFILE):
        target = folder / source
        target.parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / source).is_dir():
            shutil.copytree(ROOT / source, target, ignore=left_out, dirs_exist_ok=True)
        else:
            shutil.copy(ROOT / source, target)


def in_environment(environment: Path, command: str | Sequence[str], folder: Path) -> None:
    """Run a command, of the shell or not, with a virtual environment's programs first."""
    variables = {**os.environ, "PATH": f"{environment / 'bin'}:{os.environ['PATH']}"}
    variables |= {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_QUIET": "1"}
    subprocess.run(command, shell=isinstance(command, str), cwd=folder, env=variables, check=True)


def build(scratch: Path) -> None:
    """Run the commands of both stages, and use what comes out."""
    source, wheels = scratch / "source", scratch / "wheels"
    context(source)
    wheels.mkdir()
    shutil.copy(source / "tools" / "constraints.txt", wheels)
    for number, commands in enumerate(runs(DOCKERFILE)):
        environment = scratch / f"stage{number}"
        subprocess.run([sys.executable, "-m", "venv", environment], check=True)
        for command in commands:
            if not command.startswith(SYSTEM):
                print(f"RUN {command}", flush=True)
                here = command.replace("/source", str(source)).replace("/wheels", str(wheels))
                in_environment(environment, here, source)
    use = scratch / "use"
    use.mkdir()
    in_environment(environment, ["pip", "check"], use)
    in_environment(environment, ["python", "-c", USE], use)
    if len((use / "log.jsonl").read_text().splitlines()) != 1:
        raise SystemExit("the installed package does not run")
    size = sum(file.stat().st_size for file in environment.rglob("*") if file.is_file())
    print(f"the packages run, and take {size / 1e6:.0f} MB", flush=True)


def arm64(scratch: Path) -> None:
    """Download the wheels of all that the package needs, for arm64."""
    project = read_toml(ROOT / "host" / "pyproject.toml")["project"]
    platforms = [f"--platform={platform}" for platform in ARM64]
    kinds = [f"--python-version={PYTHON}", "--implementation=cp", "--only-binary=:all:"]
    wheels = scratch / "arm64"
    subprocess.run(
        [sys.executable, "-m", "pip", "download", "-q", "-d", wheels, *kinds, *platforms,
         "-c", ROOT / "tools" / "constraints.txt", *project["dependencies"]],
        check=True,
    )  # fmt: skip
    names = sorted(wheel.name for wheel in wheels.iterdir())
    compiled = [name for name in names if name.endswith("aarch64.whl")]
    print(f"arm64: {len(names)} wheels, {len(compiled)} of them compiled, none to be compiled")


def main() -> int:
    """Do both and return the exit status."""
    with tempfile.TemporaryDirectory() as scratch:
        try:
            build(Path(scratch))
            arm64(Path(scratch))
        except subprocess.CalledProcessError as error:
            print(f"FAIL: {error}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
