"""Every command of the documents runs: as a reader types it, in a folder like the project's.

What cannot be run as it stands is in one table, with what is run in its place or why nothing is. A
new command that is in no table is run as it stands.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import pytest
from autopilot_peer import free_port
from document_commands import DOCUMENTS, ROOT, commands
from filmed_approach import CAMERA_YAML, frames
from patience import PATIENCE_S
from simulator import Simulator
from web_camera import web_camera

import chromadock

PICTURES = 6


@dataclass(frozen=True)
class Instead:
    """``line`` is run in its place, and has this exit status; {camera} is a web camera's URL,
    {dock} the simulated dock's, {port} one that is free."""

    line: str
    why: str
    status: int = 0


@dataclass(frozen=True)
class Not:
    """Nothing is run."""

    why: str


BOARD = Not("a board at a serial port")
ROOT_ONLY = Not("root, and systemd as the computer's first process")
DOCKER = Not("Docker's daemon; make image runs what the Dockerfile does")
ROS = Not("tests/host/ros runs the commands of docs/ros.md in the environment build/ros")
COLCON = Not("colcon and an installed ROS; tests/host/ros checks the launch file")
PIP = Not("make image makes such an environment and installs into it")
STOPPED = "timeout --preserve-status -s INT 6 "
"""A camera has no end; Ctrl-C is what ends it, with status 130."""

TABLE: dict[str, Instead | Not] = {
    # A camera.
    ".venv/bin/chromadock detect 0": Instead(
        STOPPED + ".venv/bin/chromadock detect {camera}", "no camera here", 130
    ),
    ".venv/bin/chromadock detect 0 --camera cam.yaml --out 'mavlink:udpin:0.0.0.0:14555?receiver=ardusub'": Instead(  # noqa: E501
        STOPPED + ".venv/bin/chromadock detect {camera} --camera cam.yaml "
        "--out 'mavlink:udpin:127.0.0.1:{port}?receiver=ardusub'",
        "no camera here, and its port may be taken",
        130,
    ),
    ".venv/bin/chromadock run vehicle.toml": Instead(
        ".venv/bin/chromadock run vehicle.toml --set camera.source=video.mp4", "no camera here"
    ),
    ".venv/bin/chromadock doctor vehicle.toml": Instead(
        ".venv/bin/chromadock doctor vehicle.toml --set camera.source=video.mp4", "no camera here"
    ),
    ".venv/bin/chromadock run vehicle.toml --out http:8642": Instead(
        ".venv/bin/chromadock run vehicle.toml --out http:{port}", "its port may be taken"
    ),
    # Long ones, shortened.
    ".venv/bin/chromadock simulate pool --out frames": Instead(
        ".venv/bin/chromadock simulate pool --out frames --frames 2", "ten seconds of frames"
    ),
    ".venv/bin/chromadock simulate pool --out frames --seconds 10": Instead(
        ".venv/bin/chromadock simulate pool --out frames --seconds 0.2", "ten seconds of frames"
    ),
    ".venv/bin/chromadock simulate lake --out lake.mp4 --set vehicle.distance_m=1": Not(
        "ten seconds of frames; docs/simulator.md has the same with more"
    ),
    ".venv/bin/chromadock simulate lake --out lake.mp4 --set vehicle.distance_m=1 --set vehicle.heading_deg=90": Instead(  # noqa: E501
        ".venv/bin/chromadock simulate lake --out lake.mp4 --set vehicle.distance_m=1 "
        "--set vehicle.heading_deg=90 --frames 2",
        "ten seconds of frames",
    ),
    ".venv/bin/chromadock simulate my_harbour.toml --out harbour --background photographs/": Instead(  # noqa: E501
        ".venv/bin/chromadock simulate my_harbour.toml --out harbour --background photographs/ "
        "--frames 2",
        "ten seconds of frames",
    ),
    ".venv/bin/chromadock evaluate experiments/pool.toml --frames 60 --out out/pool": Not(
        "most of a minute; tests/host/evaluate/test_evaluate_cli.py runs smaller experiments"
    ),
    ".venv/bin/python -m pytest tests/parity -n 2": Not("these tests themselves"),
    ".venv/bin/pio run": Not("PlatformIO's registry; CI builds for the board"),
    ".venv/bin/pio test -e native -f test_led": Not("make test runs all of pio test beside these"),
    ".venv/bin/python tools/xtensa.py": Not("tests/parity/test_xtensa.py runs it"),
    ".venv/bin/python tools/hardware.py -k leds --port=/dev/ttyUSB0": Not(
        "a board; make test runs the suite on the simulated dock"
    ),
    # What only another computer has.
    ".venv/bin/chromadock dock flash --port /dev/ttyUSB0": BOARD,
    ".venv/bin/chromadock dock flash": BOARD,
    ".venv/bin/chromadock dock watch": Instead(
        ".venv/bin/chromadock dock watch --seconds 1 --port {dock}", "for ever"
    ),
    "cd /opt/chromadock": Instead("cd .", "is where this runs"),
    "python3 -m venv .venv": PIP,
    ".venv/bin/pip install -c tools/constraints.txt ./host": PIP,
    "adduser --system --group --no-create-home chromadock": ROOT_ONLY,
    "mkdir -p /etc/chromadock": Instead("mkdir -p etc/chromadock", "root"),
    ".venv/bin/chromadock config init /etc/chromadock/vehicle.toml": Instead(
        ".venv/bin/chromadock config init etc/chromadock/vehicle.toml", "root"
    ),
    "cp deploy/systemd/chromadock.service /etc/systemd/system/": Instead(
        "cp deploy/systemd/chromadock.service etc/", "root"
    ),
    "systemctl daemon-reload": ROOT_ONLY,
    "systemctl enable --now chromadock": ROOT_ONLY,
    "systemctl status chromadock": ROOT_ONLY,
    "journalctl -u chromadock -f": ROOT_ONLY,
    "systemctl restart chromadock": ROOT_ONLY,
    "docker buildx build --platform linux/arm64,linux/amd64 -f deploy/blueos/Dockerfile -t NAME/chromadock:0.1.0 --push .": DOCKER,  # noqa: E501
    "docker inspect --format '{{index .Config.Labels \"permissions\"}}' NAME/chromadock:0.1.0": DOCKER,  # noqa: E501
    # ROS.
    "source /opt/ros/$ROS_DISTRO/setup.bash": COLCON,
    "python3 -m venv .venv && .venv/bin/pip install ./host": PIP,
    "ln -s $PWD/ros2/chromadock_ros ~/ros2_ws/src/ && (cd ~/ros2_ws && colcon build --packages-select chromadock_ros)": COLCON,  # noqa: E501
    "source ~/ros2_ws/install/setup.bash": COLCON,
    "PATH=$PWD/.venv/bin:$PATH ros2 launch chromadock_ros chromadock.launch.py image:=/camera/image_raw vehicle:=$PWD/vehicle.toml": COLCON,  # noqa: E501
}


def treated(command: str) -> Instead | Not:
    """What is done about a command: by the table, else it is run as it stands.

    Of make it is asked what it would do, as every target takes minutes.  A dock's port is named,
    for the simulated one is at no USB port.
    """
    if command in TABLE:
        return TABLE[command]
    if command.split()[0] == "make":
        return Instead(f"make --dry-run {command.partition(' ')[2]}", "minutes")
    if command.startswith(".venv/bin/chromadock ros "):
        return ROS
    if ".venv/bin/chromadock dock " in command:
        return Instead(f"{command} --port {{dock}}", "no USB port here")
    return Instead(command, "")


@pytest.fixture(scope="module")
def camera() -> Iterator[str]:
    with web_camera() as url:
        yield url


@pytest.fixture(scope="module")
def dock(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    simulator = Simulator(tmp_path_factory.mktemp("dock") / "dock.log")
    yield simulator.url
    simulator.stop()


@pytest.fixture
def port() -> str:
    return str(free_port())


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files that a reader is taken to have."""
    folder = tmp_path_factory.mktemp("inputs")
    size = (640, 480)
    video = cv2.VideoWriter(str(folder / "video.mp4"), cv2.VideoWriter.fourcc(*"mp4v"), 20, size)
    for frame in frames(PICTURES):
        for name in ("photographs", "frames"):
            (folder / name).mkdir(exist_ok=True)
            cv2.imwrite(str(folder / name / frame.name), frame.image)
        video.write(frame.image)
    video.release()
    (folder / "cam.yaml").write_text(CAMERA_YAML)
    (folder / "vehicle.toml").write_text('[camera]\nsource = "video.mp4"\n')
    scenes = Path(chromadock.__file__).parent / "sim" / "scenes"
    shutil.copy(scenes / "pool.toml", folder / "my_harbour.toml")
    return folder


OWN = {
    "README.md": {"frames", "vehicle.toml"},
    "simulator.md": {"frames"},
}
"""Inputs that a document has its reader make."""


def project(folder: Path, inputs: Path, document: Path) -> None:
    """A folder like the project's, with the inputs in it."""
    for part in ROOT.iterdir():
        if part.name not in {"out", ".git", ".pytest_cache"}:
            (folder / part.name).symlink_to(part)
    for part in inputs.iterdir():
        if part.name not in OWN.get(document.name, set()):
            (folder / part.name).symlink_to(part)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_commands_of_a_document_run_in_its_order(
    document: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    shown = commands(document)
    if not shown:
        return
    inputs = request.getfixturevalue("inputs")
    project(tmp_path, inputs, document)
    environment = {name: value for name, value in os.environ.items() if name != "MAKEFLAGS"}
    for command in shown:
        treatment = treated(command)
        if isinstance(treatment, Not):
            continue
        line = re.sub(
            r"\{(camera|dock|port)\}", lambda name: request.getfixturevalue(name[1]), treatment.line
        )
        done = subprocess.run(
            ["bash", "-c", line],
            cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=PATIENCE_S,
        )  # fmt: skip
        said = done.stdout + done.stderr
        assert done.returncode == treatment.status, f"{command}\n{line}\n{said}"
        assert "Traceback" not in said, line


def test_the_table_has_no_command_that_no_document_shows() -> None:
    shown = {command for document in DOCUMENTS for command in commands(document)}
    assert set(TABLE) <= shown
    assert len(shown) > 60


def test_documents_call_the_command_by_where_it_is() -> None:
    """A reader who has only run the set-up has no ``chromadock`` on the path."""
    for document in DOCUMENTS:
        for command in commands(document):
            assert not re.match(r"(chromadock|pip|pio|python) ", command), document.name


def test_the_environment_of_the_documents_is_the_one_of_these_tests() -> None:
    assert Path(sys.executable).parent == ROOT / ".venv" / "bin"
