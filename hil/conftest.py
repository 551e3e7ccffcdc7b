"""Fixtures of the suite: the target, its port, and what is put right again at the end."""

from __future__ import annotations

import re
import signal
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cv2
import golden
import pytest
from filelock import FileLock, Timeout
from rig import Rig
from simulator import Simulator
from targets import BOARD, SIMULATOR, Target, flash
from wire import Tap, Wire

from chromadock.link.rgb565 import from_rgb565

TEST_TIMEOUT_S = 60
_DESELECTED = pytest.StashKey[list[str]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """`--port` and `--baud` are pytest-embedded's."""
    parser.addoption("--flash", action="store_true", help="flash the board first")


def pytest_configure(config: pytest.Config) -> None:
    """A terminated run, too, leaves the LEDs dark."""

    def stop(number: int, _: Any) -> None:
        raise KeyboardInterrupt(f"signal {number}")

    signal.signal(signal.SIGTERM, stop)
    if config.getoption("flash") and not config.getoption("port"):
        raise pytest.UsageError("--flash needs a board: give its --port")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what the other target alone can show."""
    other = "simulator" if config.getoption("port") else "board"
    left_out = [item for item in items if item.get_closest_marker(other)]
    items[:] = [item for item in items if item not in left_out]
    config.stash[_DESELECTED] = [item.name for item in left_out]
    config.hook.pytest_deselected(items=left_out)


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Name the tests that were left out: they did not pass."""
    here = "board" if config.getoption("port") else "simulator"
    for name in config.stash.get(_DESELECTED, []):
        terminalreporter.write_line(f"not on the {here}: {name}")


@pytest.fixture(scope="session")
def target(request: pytest.FixtureRequest) -> Target:
    """A board where a port is given, the simulated dock otherwise."""
    return BOARD if request.config.getoption("port") else SIMULATOR


@pytest.fixture(scope="session")
def logs(request: pytest.FixtureRequest) -> Path:
    """Where the bytes of both directions are kept: `--root-logdir`, pytest-embedded's."""
    return Path(request.config.getoption("root_logdir"))


@pytest.fixture(scope="session")
def link_baud(request: pytest.FixtureRequest) -> int:
    """The dock's LINK_BAUD: `--baud`."""
    return int(request.config.getoption("baud") or 921600)


@pytest.fixture(scope="session")
def url(
    request: pytest.FixtureRequest,
    target: Target,
    logs: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[str]:
    """The dock's port, locked against a second run of this suite."""
    if target.is_board:
        port = str(request.config.getoption("port"))
        with _Lock(port):
            if request.config.getoption("flash"):
                flash(port)
            yield port
        return
    folder = tmp_path_factory.mktemp("simulator")
    water = golden.FRAMES["pool_qqvga"]
    picture = folder / "pool.png"
    cv2.imwrite(str(picture), from_rgb565(water.data, water.width, water.height))
    arguments = [picture, "--settings", folder / "settings.bin"]
    simulator = Simulator(logs / "simulator.log", arguments)
    yield simulator.url
    simulator.stop()


@pytest.fixture(scope="session")
def wire(target: Target, url: str, link_baud: int, logs: Path) -> Iterator[Wire]:
    """The open port; open all the time, as opening may reset a board."""
    log = logs / f"{target.name}-wire.log"
    log.unlink(missing_ok=True)
    try:
        wire = Wire(url, link_baud, log)
    except OSError as error:
        pytest.exit(_why(url, error), 2)
    yield wire
    wire.close()


def _why(url: str, error: OSError) -> str:
    in_use = "lock" in str(error)
    return f"{url}: in use by another program: close it" if in_use else f"{url}: {error}"


@pytest.fixture(scope="session")
def session_rig(target: Target, wire: Wire) -> Iterator[Rig]:
    """The dock.  At the end its saved parameters are as before, and its LEDs dark."""
    rig = Rig(target, wire)
    before = rig.dock.parameters()
    try:
        yield rig
    finally:
        try:
            for name, value in before.items():
                rig.dock.set_parameter(name, value)
            rig.dock.save()
        finally:
            rig.leds_off()
            rig.close()


@pytest.fixture
def rig(session_rig: Rig, request: pytest.FixtureRequest) -> Iterator[Rig]:
    """The dock with default parameters, deciding on its camera's frames."""
    session_rig.wire.note(request.node.name)
    session_rig.defaults()
    yield session_rig
    session_rig.healthy()


@pytest.fixture
def port(wire: Wire) -> Iterator[Tap]:
    """The port as pytest-embedded's `dut` sees it."""
    tap = Tap(wire)
    yield tap
    tap.close()


@pytest.fixture
def simulate(
    tmp_path: Path, logs: Path, request: pytest.FixtureRequest
) -> Iterator[Callable[..., Rig]]:
    """Start further simulated docks, with faults: `simulate("--fault", "noise@1s")`."""
    ended: list[Callable[[], object]] = []
    name = re.sub(r"\W+", "-", request.node.name)

    def start(*arguments: str | Path) -> Rig:
        simulator = Simulator(tmp_path / "simulator.log", arguments)
        ended.append(simulator.stop)
        wire = Wire(simulator.url, 921600, logs / f"{name}-wire.log")
        ended.append(wire.close)
        return Rig(SIMULATOR, wire)

    (logs / f"{name}-wire.log").unlink(missing_ok=True)
    yield start
    for end in reversed(ended):
        end()


@pytest.fixture(autouse=True)
def no_hang() -> Iterator[None]:
    """A test that waits for ever fails, and the session goes on to its end."""

    def ring(*_: Any) -> None:
        pytest.fail(f"not done after {TEST_TIMEOUT_S} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.alarm(TEST_TIMEOUT_S)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


class _Lock:
    """One run of the suite a port, flashing included."""

    def __init__(self, port: str) -> None:
        name = re.sub(r"\W+", "-", str(Path(port).resolve()))
        self._lock = FileLock(Path(tempfile.gettempdir()) / f"chromadock-hil{name}.lock")
        self._port = port

    def __enter__(self) -> None:
        try:
            self._lock.acquire(timeout=0)
        except Timeout:
            pytest.exit(f"{self._port}: another run of this suite is using it", 2)

    def __exit__(self, *_: object) -> None:
        self._lock.release()
