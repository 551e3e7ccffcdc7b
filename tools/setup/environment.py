"""The virtual environment and the Python packages in it."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from commands import run
from paths import BUILD, CONSTRAINTS, ROOT, TOOLS, VENV, VENV_PYTHON
from report import SetupError, Unavailable, step
from stamps import Stamp

HOST = ROOT / "host"
BINDING = ROOT / "firmware" / "bindings"
DOCKCORE = ROOT / "firmware" / "lib" / "dockcore"
WHOLE_IMAGE = ROOT / "firmware" / "lib" / "wholeimage"
OPENCV4 = BUILD / "opencv4"
MAVPROXY = BUILD / "mavproxy"
MAVSDK = BUILD / "mavsdk"
ROS = BUILD / "ros"
PEERS = BUILD / "bench"
DIALECT = HOST / "chromadock" / "dialect.py"
NATIVE = [HOST / "native", HOST / "build_native.py"]
# What both packages generate their MAVLink code from, when they are built.
MAVLINK = [ROOT / "shared" / "chromadock.xml", ROOT / "shared" / "mavlink.py"]


def make_environment() -> None:
    """Create .venv; again if Python changed or the tree was moved."""
    python = f"{sys.version_info[:2]} {Path(sys.executable).resolve()}"
    stamp = Stamp(VENV, "venv", [python, str(ROOT)])
    if stamp.fresh():
        return
    with step("virtual environment .venv"):
        run([sys.executable, "-m", "venv", "--clear", VENV], "python3 -m venv")
    stamp.set()


def install_host() -> None:
    """Install the host package, editable, with the packages it needs; compile its C anew when any
    of that changed."""
    requirements = TOOLS / "requirements-demo.txt"
    package = [HOST / "pyproject.toml", HOST / "setup.py"]
    stamp = Stamp(VENV, "host", [CONSTRAINTS, requirements, *package, *NATIVE, *MAVLINK])
    compiled = list((HOST / "chromadock").glob("_native.*.so"))
    if stamp.fresh() and DIALECT.is_file() and compiled:
        return
    with step("Python packages and the host package"):
        # First what builds the packages: they are built without isolation, so
        # that the pinned build tools are used and nothing is fetched twice.
        pip_install("-c", CONSTRAINTS, "-r", requirements)
        # setuptools would take object files of other flags or headers from there.
        shutil.rmtree(HOST / "build", ignore_errors=True)
        for extension in compiled:
            extension.unlink()
        pip_install("-c", CONSTRAINTS, "--no-build-isolation", "-e", HOST)
    stamp.set()


def install_binding() -> None:
    """Compile dockcore into a Python extension, anew when any of its files changed."""
    stamp = Stamp(VENV, "binding", [CONSTRAINTS, DOCKCORE, WHOLE_IMAGE, BINDING, *MAVLINK])
    if stamp.fresh():
        return
    with step("firmware binding"):
        # setuptools would take object files of older headers from there.
        shutil.rmtree(BINDING / "build", ignore_errors=True)
        pip_install("--no-build-isolation", "--no-deps", "--force-reinstall", BINDING)
    stamp.set()


def install_test_tools() -> None:
    """Install the test runners, the checkers and PlatformIO."""
    requirements = TOOLS / "requirements-test.txt"
    stamp = Stamp(VENV, "test-tools", [CONSTRAINTS, requirements])
    if stamp.fresh():
        return
    with step("test tools and PlatformIO"):
        pip_install("-c", CONSTRAINTS, "-r", requirements)
    stamp.set()


def install_opencv4() -> None:
    """Put the newest OpenCV 4 beside OpenCV 5, for the parity tests alone."""
    install_beside(OPENCV4, "OpenCV 4")


def install_mavproxy() -> None:
    """Put MAVProxy beside the environment, for the tests of the link with real clients."""
    install_beside(MAVPROXY, "MAVProxy")


def install_mavsdk(unavailable: Unavailable) -> None:
    """Put MAVSDK beside the environment, for the tests of what an autopilot is told; there is not
    a wheel of it for every computer."""
    try:
        install_beside(MAVSDK, "MAVSDK")
    except SetupError as error:
        unavailable.add("mavsdk", str(error))


def make_ros(unavailable: Unavailable) -> None:
    """Make an environment with ROS 2's client library, for the tests of the node; there is not a
    wheel of it for every computer.

    A whole environment, since its libraries are sought by Python's prefix.  Packages without those
    they need: numpy and PyYAML are in .venv, which the tests have it see.
    """
    requirements = TOOLS / "requirements-ros.txt"
    stamp = Stamp(ROS, "ros", [requirements, f"{sys.version_info[:2]}", str(ROOT)])
    if stamp.fresh():
        return
    try:
        with step("ROS 2 in build/ros"):
            run([sys.executable, "-m", "venv", "--clear", ROS], "python3 -m venv")
            pip_install("--no-deps", "-r", requirements, python=ROS / "bin" / "python")
        stamp.set()
    except SetupError as error:
        shutil.rmtree(ROS, ignore_errors=True)
        unavailable.add("ros", str(error))


def install_peers() -> None:
    """Put what the detector is compared with beside the environment, for `make bench` alone."""
    install_beside(PEERS, "peers of the bench")


def install_beside(folder: Path, title: str) -> None:
    """Install packages without those they need into a folder of their own."""
    requirements = TOOLS / f"requirements-{folder.name}.txt"
    stamp = Stamp(folder, folder.name, [requirements, str(sys.version_info[:2])])
    if stamp.fresh():
        return
    with step(f"{title} in build/{folder.name}"):
        shutil.rmtree(folder, ignore_errors=True)
        pip_install("--no-deps", "--target", folder, "-r", requirements)
    stamp.set()


def pip_install(*arguments: str | Path, python: Path = VENV_PYTHON) -> None:
    """Install by an environment's pip.

    Python compiles what is imported when it is; to compile all would take longer than the rest.
    """
    pip: list[str | Path] = [python, "-m", "pip", "install", "-q", "--no-compile"]
    run([*pip, *arguments], "pip install", environment={"PIP_DISABLE_PIP_VERSION_CHECK": "1"})
