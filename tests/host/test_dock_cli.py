"""``chromadock dock`` against simulated docks at their pseudo-terminals and TCP ports."""

import os
import pty
import re
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from patience import PATIENCE_S
from simulation import chromadock, running_dock

from chromadock import dialect, method
from chromadock.cli import dock_status
from chromadock.link import Connection, DockClient, pictures
from chromadock.link import discovery as discovery_module
from chromadock.link.messenger import Messenger
from chromadock.parameter_table import PARAMETERS
from chromadock.simulated import parse_fault

COMMAND = [sys.executable, "-m", "chromadock", "dock"]


@pytest.fixture(scope="module", params=["pseudo-terminal", "tcp"])
def url(request):
    with running_dock(tcp=request.param == "tcp") as (url, _dock):
        with DockClient(Connection(url)) as client:
            while client.status().faults:  # until the camera has settled
                pass
        yield url


@pytest.fixture
def dock(url, capsys):
    """Runs a command that must succeed; returns what it printed."""

    def run(*arguments):
        done = chromadock(capsys, "dock", *arguments, "--port", url)
        assert done.status == 0, done.err
        return done.out

    yield run
    with DockClient(Connection(url)) as client:
        client.led_auto()
        client.reset()
        client.set_parameter("LED_LIMIT", 255)
        client.set_parameter("LED_ANODE", 0)


def status_of(url):
    with DockClient(Connection(url)) as client:
        return client.status()


def test_info_tells_version_method_and_state(dock, url):
    out = dock("info")
    assert f"port      {url}" in out
    assert "firmware  simulate" in out
    assert method.DIGEST in out
    assert "#29a2ce  195.9°" in out
    assert re.search(r"faults +none", out)
    assert re.search(r"sensor +OV2640 *\n", out)
    assert re.search(r"locked +yes, the picture followed", out)


@pytest.mark.parametrize(
    ("number", "says"),
    [
        (0x26, "OV2640"),
        (0x3660, "OV3660, unproven"),
        (0x5640, "OV5640, unproven"),
        (0x2145, "GC2145, unfit"),
        (0x9B, "unknown 0x9b, unproven"),
        (0, "none"),
    ],
)
def test_a_sensor_is_named_with_what_is_known_of_it(number, says):
    assert dock_status.sensor(SimpleNamespace(sensor=number)).startswith(says)


def test_watch_prints_a_line_a_second_where_stdout_is_no_terminal(dock):
    lines = dock("watch", "--seconds", 1.6).splitlines()
    assert len(lines) in (1, 2)
    for line in lines:
        assert "water 195.9° #29a2ce" in line
        assert "marker 315.9°" in line
        assert "faults: none" in line


def test_watch_goes_on_where_the_dock_reports_nothing_by_itself(dock):
    dock("params", "set", "REPORT_HZ", 0)
    assert len(dock("watch", "--seconds", 1.3).splitlines()) == 1


def test_params_list_shows_each_with_its_value_and_range(dock):
    lines = dock("params", "list").splitlines()[1:]
    assert [line.split()[0] for line in lines] == [p.name for p in PARAMETERS]
    assert re.search(r"MAPPING +ternary +ternary \| complement \| contrast +ternary", lines[0])
    assert re.search(r"WINDOW_MS +2000 ms +100 .. 2000 ms +2000 ms", lines[1])


@pytest.mark.parametrize(
    ("name", "value", "shown"),
    [
        ("MAPPING", "complement", "complement"),
        ("mapping", "1", "complement"),
        ("MAPPING", "comp", "complement"),
        ("MAPPING", "contrast", "contrast"),
        ("mapping", "2", "contrast"),
        ("LED_GAMMA", "1.8", "1.8"),
        ("LED_GAMMA", "1", "1.0"),
        ("CAM_LOCK", "auto", "automatic, for focusing and snapshots only"),
        ("WINDOW_MS", "500", "500 ms"),
        ("LED_OFFSET_R", "-20", "-20"),
        ("LED_M_RG", "-0.25", "-0.25"),
        ("LED_HUE", "120.3", "120.2344 deg"),
        ("LED_HUE", "359.765625", "359.7656 deg"),
    ],
)
def test_a_parameter_is_set_by_number_or_name_and_read_back(dock, name, value, shown):
    assert dock("params", "set", name, value).startswith(f"{name.upper()} = {shown} until")
    assert dock("params", "get", name).startswith(f"{name.upper()} = {shown}  (")


def test_every_parameter_takes_both_ends_of_its_range(url, dock):
    with DockClient(Connection(url)) as client:
        for p in PARAMETERS:
            assert client.set_parameter(p.name, p.minimum) == p.minimum
            assert client.set_parameter(p.name, p.maximum) == p.maximum
        assert client.parameters() == {p.name: p.maximum for p in PARAMETERS}


def test_params_load_sets_all_of_a_file(dock, tmp_path):
    file = tmp_path / "dock.toml"
    file.write_text('LED_LIMIT = 77\nMAPPING = "complement"\nLED_GAMMA = 2.8\nLED_HUE = 12.5\n')
    assert dock("params", "load", file).startswith("4 parameters set")
    for name, shown in (("LED_LIMIT", "77"), ("MAPPING", "complement"), ("LED_GAMMA", "2.8")):
        assert f"= {shown} " in dock("params", "get", name)


def test_params_reset_brings_the_defaults_back(dock):
    dock("params", "set", "WINDOW_MS", 900)
    dock("params", "reset")
    assert "= 2000 " in dock("params", "get", "WINDOW_MS")


def test_params_reset_leaves_brightness_and_polarity_to_the_wiring(dock):
    dock("params", "set", "LED_LIMIT", 9)
    dock("params", "set", "LED_ANODE", 1)
    dock("params", "reset")
    assert "= 9 " in dock("params", "get", "LED_LIMIT")
    assert "= low pin lights" in dock("params", "get", "LED_ANODE")


def test_what_is_saved_outlasts_a_reboot_and_what_is_not_does_not(dock):
    dock("params", "set", "LED_LIMIT", 123)
    dock("params", "save")
    dock("params", "set", "LED_LIMIT", 5)
    assert dock("reboot") == "the dock has restarted\n"
    assert "= 123 " in dock("params", "get", "LED_LIMIT")
    dock("params", "reset")
    dock("params", "save")


def test_led_shows_raw_duties_a_hue_or_the_marker(dock, url):
    dock("led", 255, 0, 128)
    assert list(status_of(url).duty) == [4096, 0, 2056]
    assert status_of(url).led_mode == dialect.DOCK_LED_RAW
    dock("led", 120)
    assert list(status_of(url).duty) == [0, 4096, 0]
    dock("led", "auto")
    assert list(status_of(url).duty) == [4096, 0, 2070]
    assert status_of(url).led_mode == dialect.DOCK_LED_AUTO


def test_a_snapshot_is_the_cameras_frame(dock, tmp_path):
    out = tmp_path / "frame.png"
    assert dock("snapshot", out) == f"wrote {out}: 160x120\n"
    picture = cv2.imread(str(out))
    assert picture.shape == (120, 160, 3)
    assert (picture == (206, 162, 41)).all()  # the water's (200, 160, 40) in 5, 6, 5 bits
    assert [p.name for p in tmp_path.iterdir()] == ["frame.png"]


def test_an_injected_frame_is_decided_on_instead_of_the_cameras(dock, tmp_path):
    for name, colour in (("green", (0, 200, 0)), ("red", (0, 0, 200))):
        cv2.imwrite(str(tmp_path / f"{name}.png"), np.full((120, 160, 3), colour, np.uint8))
    lines = dock("inject", tmp_path / "green.png", tmp_path / "red.png").splitlines()
    assert len(lines) == 2
    assert lines[0].startswith("green.png: ")
    assert "water 120.0°" in lines[0]
    assert "water 0.0°" in lines[1]


def test_the_camera_is_back_at_once_after_an_injection(dock, url, tmp_path):
    picture = tmp_path / "green.png"
    cv2.imwrite(str(picture), np.full((120, 160, 3), (0, 200, 0), np.uint8))
    dock("inject", picture)
    dock("snapshot", tmp_path / "after.png")
    assert round(status_of(url).background_hue * 360 / 1536, 1) == 195.9


def test_a_picture_that_cannot_be_injected_is_told_and_the_others_are(dock, url, tmp_path, capsys):
    for name in ("1.png", "3.png"):
        cv2.imwrite(str(tmp_path / name), np.full((120, 160, 3), (0, 200, 0), np.uint8))
    (tmp_path / "2.png").write_bytes(b"words")
    done = chromadock(capsys, "dock", "inject", tmp_path, "--port", url)
    assert done.status == 1
    assert [line.split(": ")[0] for line in done.out.splitlines()] == ["1.png", "3.png"]
    (line,) = done.err.splitlines()
    assert line.startswith(f"chromadock: error: {tmp_path / '2.png'}: not a whole picture")


def test_rgb888_frames_can_be_injected(url, dock):
    with DockClient(Connection(url)) as client:
        pixels = bytes([10, 20, 200]) * (120 * 100)
        status = client.inject(pixels, 120, 100, dialect.MAVLINK_DATA_STREAM_IMG_RAW32U)
        client.end_injection()
    assert list(status.background_rgb) == [10, 20, 200]


class Lossy(Connection):
    """A line on which the fifth packet of the first picture is lost, either way."""

    def __init__(self, url):
        super().__init__(url)
        self.lost = 0

    def read(self, timeout_s):
        return self._less(super().read(timeout_s))

    def write(self, data):
        super().write(self._less(data))

    def _less(self, data):
        fifth = re.compile(rb"(?<=\x83\0\0)\x04\0", re.DOTALL)
        if self.lost == 0:
            data, self.lost = fifth.subn(b"\x55\0", data, count=1)
        return data


def test_a_snapshot_with_a_lost_packet_is_asked_for_again():
    with running_dock() as (url, _dock):
        line = Lossy(url)
        with DockClient(line) as client:
            data, width, height = client.snapshot()
        assert line.lost == 1
    assert (len(data), width, height) == (38400, 160, 120)
    assert len(set(data[i : i + 2] for i in range(0, len(data), 2))) == 1


def test_an_injected_frame_with_a_lost_packet_is_sent_again():
    with running_dock() as (url, _dock):
        line = Lossy(url)
        heard = []
        with DockClient(line, on_text=lambda _severity, text: heard.append(text)) as client:
            status = client.inject(bytes([10, 20, 200]) * 12000, 120, 100, pictures.RGB888)
        assert line.lost == 1
    assert list(status.background_rgb) == [10, 20, 200]
    assert "injected frame dropped: lost packet 4" in heard


def test_the_log_has_all_bytes_of_both_directions(dock, url, tmp_path):
    log = tmp_path / "raw.log"
    dock("info", "--log", log)
    lines = [line.split() for line in log.read_text().splitlines()]
    assert {way for _, way, _ in lines} == {"<", ">"}
    times = [float(time_s) for time_s, _, _ in lines]
    assert times == sorted(times)
    assert all(bytes.fromhex(data)[0] == 0xFD for _, way, data in lines if way == ">")


def test_the_host_sends_a_heartbeat_every_second(monkeypatch):
    sent = []

    class Silent:
        url = "nowhere"
        now_s = 0.0

        def read(self, timeout_s):
            self.now_s += max(timeout_s, 0.001)
            return b""

        def write(self, data):
            sent.append((self.now_s, data))

    line = Silent()
    messenger = Messenger(line, clock=lambda: line.now_s)
    assert messenger.receive(4.5) is None
    assert [round(at) for at, _ in sent] == [0, 1, 2, 3, 4]
    assert all(data[5:7] == bytes([255, 190]) for _, data in sent)


def test_without_port_the_only_dock_is_found(capsys, monkeypatch):
    with running_dock() as (first, _), running_dock() as (second, _):
        monkeypatch.setattr(discovery_module, "candidates", lambda: [first])
        assert f"port      {first}" in chromadock(capsys, "dock", "info").out
        other, silent = os.openpty()
        monkeypatch.setattr(discovery_module, "candidates", lambda: [os.ttyname(silent), second])
        assert f"port      {second}" in chromadock(capsys, "dock", "info", "--timeout", 0.5).out
        os.close(other)
        os.close(silent)


@pytest.fixture(scope="module")
def process():
    """``simulate`` as the user runs it."""
    command = [*COMMAND, "simulate", "--tcp", "localhost:0", "--fps", "20"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as p:
        yield p
        if p.poll() is None:
            p.kill()


def test_simulate_tells_its_port_serves_it_and_ends_when_told(process, capsys):
    line = process.stdout.readline()
    assert re.fullmatch(r"port: socket://127\.0\.0\.1:\d+\n", line)
    port = line.removeprefix("port: ").strip()
    assert chromadock(capsys, "dock", "info", "--port", port).status == 0
    process.send_signal(signal.SIGTERM)
    assert process.wait(3) == 143
    assert process.stderr.read() == ""


def test_watch_on_a_terminal_is_a_table_with_colours():
    parent, child = pty.openpty()
    environment = {**os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor"}
    with (
        running_dock() as (url, _dock),
        subprocess.Popen(
            [*COMMAND, "watch", "--seconds", "0.5", "--port", url],
            stdout=child,
            stderr=subprocess.PIPE,
            env=environment,
        ) as p,
    ):
        os.close(child)
        shown = b""
        try:
            while piece := os.read(parent, 65536):
                shown += piece
        except OSError:  # the terminal's way to say that all have left
            pass
        assert p.wait(PATIENCE_S) == 0, p.stderr.read()
    os.close(parent)
    assert b"48;2;41;162;206m" in shown  # the water's swatch
    assert b"48;2;255;0;187m" in shown  # the marker's
    assert b"duties R G B" in shown


def test_simulate_says_in_its_help_what_it_does_not_imitate(capsys):
    out = chromadock(capsys, "dock", "simulate", "--help").out
    assert "Not imitated" in out
    assert "watchdog" in out


def test_a_command_ends_soon(url, capsys):
    start = time.monotonic()
    assert chromadock(capsys, "dock", "params", "get", "MAPPING", "--port", url).status == 0
    assert time.monotonic() - start < 2.5


def test_watch_passes_on_what_the_dock_says(capsys):
    with running_dock(faults=(parse_fault("camera-lost@0.6s"),)) as (url, _dock):
        done = chromadock(capsys, "dock", "watch", "--seconds", 1.0, "--port", url)
    assert done.err == "dock: camera gives no frame: colour kept, restarting it\n"
