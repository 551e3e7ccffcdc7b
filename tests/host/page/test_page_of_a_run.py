"""The live page of a real run: asked over HTTP, and opened in a browser."""

from __future__ import annotations

import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
import pytest
from autopilot_peer import free_port
from browser import open_browser, requests, why_no_browser
from patience import PATIENCE_S
from web_camera import RANGE_M, web_camera

from chromadock import Detection
from chromadock.output.page.server import MOST_CLIENTS
from chromadock.ros.mcap_bag import McapBag
from chromadock.ros.topics import RECORD
from chromadock.vehicle.reading import read_vehicle

SHOTS = os.environ.get("CHROMADOCK_SHOTS")
"""A folder for pictures of the page, for those who want to look at it."""


@pytest.fixture(scope="module")
def camera() -> Iterator[str]:
    with web_camera() as url:
        yield url


@contextmanager
def running(folder: Path, *options: str) -> Iterator[subprocess.Popen[str]]:
    """``chromadock run v.toml`` there, ended at the end in any case."""
    command = [sys.executable, "-m", "chromadock", "run", "v.toml", *options]
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ) as run:
        try:
            yield run
        finally:
            run.kill()


def ask(port: int, path: str) -> tuple[int, str, bytes]:
    """Status, type and content of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    connection.request("GET", path)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer.status, answer.headers["Content-Type"], content


def status(port: int) -> dict[str, Any]:
    code, kind, content = ask(port, "/status.json")
    assert (code, kind) == (200, "application/json")
    found: dict[str, Any] = json.loads(content)
    return found


def until(port: int, true: Any) -> dict[str, Any]:
    """The first status for which it is true."""
    end, last = time.monotonic() + PATIENCE_S, None
    while time.monotonic() < end:
        try:
            last = status(port)
        except OSError:
            last = None
        if last is not None and true(last):
            return last
        time.sleep(0.1)
    raise AssertionError(last)


def tracking(found: dict[str, Any]) -> bool:
    track = found.get("result", {}).get("track")
    return track is not None and track["state"] == "tracking"


def test_the_page_of_a_run_is_answered_over_http(camera: str, tmp_path: Path) -> None:
    port, vehicle_port = free_port(socket.SOCK_STREAM), free_port()
    secret = camera.replace("http://", "http://me:secret@")
    autopilot = f"mavlink:udpin:127.0.0.1:{vehicle_port}?receiver=ardusub"
    (tmp_path / "v.toml").write_text(
        f'[camera]\nsource = "{secret}"\n[outputs]\nrecord = "dive.mcap"\noverlay = "seen.mp4"\n'
        f'results = ["http:{port}", "{autopilot}", "json:/dev/full"]\n'
    )
    (tmp_path / "other.mcap").write_text("of somebody else")
    with running(tmp_path) as run:
        found = until(port, tracking)
        pose = found["result"]["track"]["pose"]
        assert np.linalg.norm(pose["t"]) == pytest.approx(RANGE_M, rel=0.05)
        assert Detection.from_dict(found["result"]).found
        assert found["trouble"] is None and 0 < found["age_s"] < 2
        assert found["frames"] > 2 and 0 < found["rate_hz"] < 40
        troubles = {output["name"]: output["trouble"] for output in found["outputs"]}
        assert troubles.pop(autopilot) == "no heartbeat of the vehicle is heard"
        full = troubles.pop("json:/dev/full")
        assert full.startswith("cannot be written (No space left on device): check disk and folder")
        assert troubles == {f"http:{port}": None, "mcap:dive.mcap": None}

        assert ask(port, "/healthz") == (200, "text/plain; charset=utf-8", b"ok\n")
        code, kind, content = ask(port, "/picture.jpg?7")
        picture = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_COLOR)
        assert (code, kind) == (200, "image/jpeg") and picture.shape == (480, 640, 3)
        _, _, text = ask(port, "/vehicle.toml")
        assert "secret" not in text.decode() and "http://...@127.0.0.1" in text.decode()
        assert "secret" not in json.dumps(status(port))

        assert [file["name"] for file in found["recordings"]] == ["dive.mcap"]
        _, kind, start = ask(port, "/recordings/dive.mcap")
        assert kind == "application/x-mcap" and start.startswith(b"\x89MCAP")
        for path in ("/recordings/other.mcap", "/recordings/../v.toml", "/recordings/%2e%2e/v.toml",
                     "/v.toml", "/recordings/", "/recordings"):  # fmt: skip
            assert ask(port, path)[0] == 404, path

        run.send_signal(signal.SIGTERM)
        assert run.stderr is not None
        said = run.stderr.read()
        assert run.wait(10) == 0, said
    assert "Traceback" not in said
    whole = McapBag(tmp_path / "dive.mcap")
    assert whole.cut_short is None and len(list(whole.messages(RECORD))) >= found["frames"]
    with av.open(str(tmp_path / "seen.mp4")) as video:
        assert sum(1 for _ in video.decode(video=0)) >= found["frames"]


def test_what_blueos_asks_for_is_answered_as_its_helper_reads_it(
    camera: str, tmp_path: Path
) -> None:
    """Its ``helper``: GET / with 200 and a title, then these texts of /register_service."""
    port = free_port(socket.SOCK_STREAM)
    (tmp_path / "v.toml").write_text(f'[camera]\nsource = "{camera}"\n')
    with running(tmp_path, "--out", f"http:{port}"):
        until(port, lambda found: found["frames"] > 0)
        code, kind, page = ask(port, "/")
        assert code == 200 and kind.startswith("text/html") and b"<title>Chromadock<" in page
        code, kind, content = ask(port, "/register_service")
    told = json.loads(content)
    assert (code, kind) == (200, "application/json")
    wanted = ("name", "description", "icon", "company", "version", "webpage", "api")
    assert all(isinstance(told[key], str) for key in wanted)
    assert told["icon"].startswith("mdi-") and told["version"]
    assert told["works_in_relative_paths"] is True and told["new_page"] is False


def test_clients_that_hang_do_not_hold_up_the_detection(camera: str, tmp_path: Path) -> None:
    port = free_port(socket.SOCK_STREAM)
    log = tmp_path / "log.jsonl"
    (tmp_path / "v.toml").write_text(
        f'[camera]\nsource = "{camera}"\n[outputs]\nresults = ["http:{port}", "json:{log}"]\n'
    )
    with running(tmp_path) as run, ExitStack() as stack:
        until(port, lambda found: found["frames"] > 5)
        for number in range(2 * MOST_CLIENTS):
            client = stack.enter_context(socket.create_connection(("127.0.0.1", port)))
            if number % 2:
                client.send(b"GET /picture.jpg HT")  # and never more
        before = len(log.read_bytes().splitlines())
        time.sleep(2)
        after = len(log.read_bytes().splitlines())
        assert after - before >= 10
        turned_away = stack.enter_context(socket.create_connection(("127.0.0.1", port)))
        assert turned_away.recv(1) == b""
        run.send_signal(signal.SIGTERM)
        assert run.wait(5) == 0


def test_with_retry_nothing_at_fault_ends_the_run_and_its_page_says_what(
    camera: str, tmp_path: Path
) -> None:
    port = free_port(socket.SOCK_STREAM)
    vehicle = tmp_path / "v.toml"
    missing = 'camera.source="/dev/no-such-camera"'
    with running(tmp_path, "--out", f"http:{port}", "--retry", "--set", missing) as run:
        found = until(port, lambda found: "no-such-camera" in (found["trouble"] or ""))
        assert read_vehicle(vehicle).camera.source == "0"  # the shipped file
        assert found["frames"] == 0 and "result" not in found
        assert ask(port, "/healthz")[0] == 503
        vehicle.write_text("[camera]\nsorce = 1\n")
        until(port, lambda found: "v.toml: " in (found["trouble"] or ""))
        run.send_signal(signal.SIGTERM)
        assert run.wait(5) == 0
    with running(tmp_path, "--out", f"http:{port}", "--retry") as run:
        until(port, lambda found: "v.toml: " in (found["trouble"] or ""))
        vehicle.write_text(f'[camera]\nsource = "{camera}"\n')
        assert until(port, tracking)["trouble"] is None
        run.send_signal(signal.SIGTERM)
        assert run.wait(5) == 0


def test_a_slip_in_an_output_is_refused_with_retry_too(tmp_path: Path) -> None:
    with running(tmp_path, "--out", "pigeon:home", "--retry") as run:
        assert run.stderr is not None
        said = run.stderr.read()
        assert run.wait(10) == 2
    assert said.count("\n") == 1 and "pigeon:home: no such output" in said


def test_a_port_that_is_taken_is_told_in_a_line(tmp_path: Path) -> None:
    (tmp_path / "v.toml").write_text('[camera]\nsource = "."\n')
    cv2.imwrite(str(tmp_path / "0.png"), np.full((120, 160, 3), (140, 110, 30), np.uint8))
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with running(tmp_path, "--out", f"http:{taken.getsockname()[1]}") as run:
            assert run.stderr is not None
            said = run.stderr.read()
            assert run.wait(10) == 2
    assert said.count("\n") == 1 and "cannot listen there (Address already in use)" in said


@pytest.mark.skipif(why_no_browser() is not None, reason=str(why_no_browser()))
@pytest.mark.parametrize("width", [420, 1200])
def test_a_browser_shows_the_page_without_a_fault(camera: str, tmp_path: Path, width: int) -> None:
    port = free_port(socket.SOCK_STREAM)
    (tmp_path / "v.toml").write_text(
        f'[camera]\nsource = "{camera}"\n[outputs]\nresults = ["http:{port}", "json:/dev/full"]\n'
        'record = "dive.mcap"\n'
    )
    with running(tmp_path) as run, open_browser(tmp_path) as browser:
        until(port, tracking)
        size = {"width": width, "height": 1000, "deviceScaleFactor": 1, "mobile": width < 600}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        browser.get(f"http://127.0.0.1:{port}/")
        look = (
            "const image = document.querySelector('img');"
            "return [document.getElementById('state').textContent, image.naturalWidth,"
            " document.documentElement.scrollWidth <= innerWidth,"
            " document.getElementById('trouble').hidden,"
            " document.querySelectorAll('#outputs .bad').length,"
            " document.querySelectorAll('#recordings a').length]"
        )
        end = time.monotonic() + PATIENCE_S
        while (seen := browser.execute_script(look)) != ["tracking", 640, True, True, 1, 1]:
            assert time.monotonic() < end, seen
            time.sleep(0.2)
        if SHOTS:
            browser.save_screenshot(str(Path(SHOTS) / f"page-{width}.png"))
        run.send_signal(signal.SIGTERM)
        run.wait(10)
        while browser.execute_script(look)[3]:
            assert time.monotonic() < end
            time.sleep(0.2)
        said = browser.execute_script("return document.getElementById('trouble').textContent")
        assert "not running" in said
        if SHOTS:
            browser.save_screenshot(str(Path(SHOTS) / f"page-gone-{width}.png"))
        asked = [url for url in requests(browser) if not url.startswith("chrome:")]
        asked = [url for url in asked if not url.startswith(f"http://127.0.0.1:{port}/")]
        assert asked == []
        faults = [line["message"] for line in browser.get_log("browser")]
        assert all("ERR_CONNECTION_REFUSED" in fault for fault in faults), faults
