"""Exposure and white balance of a camera behind BlueOS's camera manager: over real HTTP."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest
from autopilot_peer import free_port
from camera_manager import (
    EXPOSURE,
    EXPOSURE_AUTO,
    GAIN,
    WHITE_BALANCE,
    WHITE_BALANCE_AUTO,
    Manager,
    usual,
)

from chromadock.controls import keeper as keeping
from chromadock.controls import manager as reaching
from chromadock.controls.applying import Held, apply
from chromadock.controls.base import ControlsAwayError
from chromadock.controls.keeper import Keeper
from chromadock.controls.manager import CameraManager, ManagerAddress, manager_address
from chromadock.controls.opening import CameraSettings, controls_of
from chromadock.doctor import camera as eyes
from chromadock.errors import ChromadockError
from chromadock.sources.grabber import Grabber, Shot
from chromadock.sources.kept import kept
from chromadock.sources.live import Live

ONE, TWO = "/dev/video0", "/dev/video2"


@pytest.fixture
def manager() -> Iterator[Manager]:
    with Manager(ONE) as server:
        yield server


def applied(manager: Manager, query: str = "", stream: str = "", **wishes: Any) -> list[str]:
    with CameraManager(manager_address(manager.url + query), stream) as controls:
        return apply(controls, wishes, Held(), settled=True)


def away(manager: Manager, query: str = "", stream: str = "") -> str:
    with pytest.raises(ControlsAwayError) as error:
        applied(manager, query, stream, exposure=8.2)
    assert "\n" not in str(error.value) and len(str(error.value)) < 300
    return str(error.value)


# --- the same keys, by REST ---


def test_automatics_go_off_before_values_are_set(manager: Manager) -> None:
    assert applied(manager, exposure=8.2, gain=40, white_balance=5000) == []
    assert manager.value(ONE, EXPOSURE_AUTO) == 1 and manager.value(ONE, EXPOSURE) == 82
    assert manager.value(ONE, WHITE_BALANCE_AUTO) == 0
    assert manager.value(ONE, WHITE_BALANCE) == 5000 and manager.value(ONE, GAIN) == 40
    assert manager.posts[0] == {"device": ONE, "v4l_id": EXPOSURE_AUTO, "value": 1}


def test_locked_and_automatic(manager: Manager) -> None:
    manager.set(ONE, WHITE_BALANCE, 3900)
    assert applied(manager, white_balance="lock") == []
    assert manager.value(ONE, WHITE_BALANCE_AUTO) == 0
    assert manager.value(ONE, WHITE_BALANCE) == 3900
    assert applied(manager, white_balance="auto") == []
    assert manager.value(ONE, WHITE_BALANCE_AUTO) == 1


def test_what_is_beyond_the_range_is_fitted_for_the_manager_would_refuse_it(
    manager: Manager,
) -> None:
    assert applied(manager, exposure=900) == [
        "camera.exposure: 900 ms is wanted, but the camera manager has 500 ms; "
        "it takes 0.1 to 500 ms"
    ]


def test_what_is_taken_and_not_kept_is_named_and_so_is_what_is_refused(manager: Manager) -> None:
    manager.ignores = {EXPOSURE_AUTO, GAIN}
    lines = applied(manager, exposure=8.2, gain=40)
    assert lines[0].startswith("camera.exposure: the camera manager leaves it automatic (Internal")
    assert "Control is inactive" in lines[0] and "\n" not in lines[0]
    assert lines[1] == (
        "camera.gain: 40 is wanted, but the camera manager has 0; it takes 0 to 100"
    )


# --- which camera ---


def test_the_camera_is_the_one_behind_the_stream_that_is_watched() -> None:
    with Manager(ONE, TWO) as manager:
        manager.streams = [
            ("rtsp://192.168.2.2:8554/video_0", ONE), ("rtsp://192.168.2.2:8554/video_1", TWO)
        ]  # fmt: skip
        assert applied(manager, stream="rtsp://me:secret@blueos.local:8554/video_1", gain=7) == []
        assert (manager.value(ONE, GAIN), manager.value(TWO, GAIN)) == (0, 7)
        assert applied(manager, f"?device={ONE}", "rtsp://blueos.local:8554/video_1", gain=9) == []
        assert (manager.value(ONE, GAIN), manager.value(TWO, GAIN)) == (9, 7)
        said = away(manager, stream="rtsp://blueos.local:8554/other")
        assert f"has {ONE}, {TWO}" in said and "add ?device=NAME" in said
        assert f"has no camera /dev/video9, but {ONE}, {TWO}" in away(
            manager, "?device=/dev/video9"
        )


def test_the_only_camera_is_the_one_where_no_stream_tells(manager: Manager) -> None:
    assert applied(manager, stream="udp://192.168.2.1:5600", gain=7) == []
    assert manager.value(ONE, GAIN) == 7


@pytest.mark.parametrize(
    ("source", "asked", "reached"),
    [
        ("rtsp://me:pw@192.168.2.2:8554/video_0", "", "http://192.168.2.2:6020"),
        ("rtsp://[fe80::2]:8554/video_0", "", "http://[fe80::2]:6020"),
        ("RTSPS://cam.local/x", "", "http://cam.local:6020"),
        ("udpsrc port=5600 ! appsink", "http://blueos.local", "http://blueos.local:6020"),
        (
            "udp://h:5600",
            "http://10.0.0.1:80/manager/?device=/dev/video2",
            "http://10.0.0.1:80/manager",
        ),
    ],
)
def test_the_managers_address_is_given_or_follows_from_the_stream(
    source: str, asked: str, reached: str
) -> None:
    opener = controls_of(source, asked)
    assert opener is not None
    controls = opener()
    assert isinstance(controls, CameraManager) and str(controls._address) == reached


@pytest.mark.parametrize("source", ["dive.mp4", "http://host/video.mp4", "videotestsrc ! appsink"])
def test_recordings_and_pipelines_have_no_controls(source: str) -> None:
    assert controls_of(source) is None


def test_a_camera_of_this_computer_is_not_the_managers() -> None:
    if sys.platform != "linux":
        pytest.skip("V4L2 is Linux's")
    opener = controls_of("97", "http://192.168.2.2:6020")
    assert opener is not None
    with pytest.raises(ControlsAwayError, match="/dev/video97"):
        opener()


@pytest.mark.parametrize(
    "text",
    ["192.168.2.2:6020", "https://h", "http://", "http://h:x", "http://me:pw@h", "http://h?dev=1",
     "http://h:99999", "http://h#x", "http://[h"],
)  # fmt: skip
def test_an_address_of_another_form_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(ChromadockError, match=r"camera\.manager is .*: write http://HOST:6020"):
        manager_address(text)


# --- a manager that does not do as it should ---


def test_one_that_is_away_is_told() -> None:
    controls = CameraManager(ManagerAddress("127.0.0.1", free_port()))
    with pytest.raises(ControlsAwayError, match=r"does not answer \(Connection refused\)"):
        controls.read()


@pytest.mark.parametrize("status", [404, 500, 503, 302])
def test_one_that_fails_is_told_with_its_status(manager: Manager, status: int) -> None:
    manager.status = status
    assert f"answers /v4l with status {status}" in away(manager)


@pytest.mark.parametrize("text", ["<!DOCTYPE html>", "", "{}", '[{"source": 3}]', "[" * 10000])
def test_a_server_that_is_no_camera_manager_is_told(manager: Manager, text: str) -> None:
    manager.text = text
    assert "answers, but not as a camera manager" in away(manager)


def test_one_that_says_nothing_is_given_up(
    manager: Manager, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reaching, "_ANSWER_S", 0.2)
    manager.slow_s = 1.0
    assert "does not answer (timed out)" in away(manager)


def test_streams_that_cannot_be_understood_leave_the_only_camera(manager: Manager) -> None:
    manager.streams = [("rtsp://h:8554/a", ONE)]
    manager.playing = lambda: [{"video_and_stream": None}, 3]  # type: ignore[method-assign]
    assert applied(manager, stream="rtsp://h:8554/a", gain=3) == []


# --- while pictures are taken ---


class Pictures(Grabber):
    """Black, 100 a second, until the camera is ``lost``."""

    def __init__(self, lost: threading.Event) -> None:
        self._lost = lost

    def grab(self) -> Shot | None:
        time.sleep(0.01)
        return None if self._lost.is_set() else Shot(np.zeros((4, 4, 3), np.uint8), None)

    def close(self) -> None:
        """It may be opened again."""
        self._lost.clear()


def until(what: Callable[[], bool]) -> None:
    end_s = time.monotonic() + 20
    while not what():
        assert time.monotonic() < end_s, "it never came"
        time.sleep(0.02)


def source_of(
    manager: Manager, lost: threading.Event, told: list[str], **wishes: Any
) -> Callable[[], Live]:
    opener = partial(CameraManager, manager_address(manager.url))
    keeper = Keeper(opener, wishes, "stream", told.append)
    return lambda: Live(kept(lambda: Pictures(lost), keeper), "stream", told.append)


def test_a_stream_that_comes_back_has_its_camera_set_again_and_nothing_is_told_twice(
    manager: Manager,
) -> None:
    manager.slow_s = 0.05
    lost, told = threading.Event(), list[str]()
    with source_of(manager, lost, told, gain=500, exposure=8.2)() as source:
        frames = iter(source)
        next(frames)
        assert manager.value(ONE, EXPOSURE) == 82, "set before the first picture"
        until(lambda: len(told) == 1)
        manager.cameras[ONE] = usual()  # plugged in again
        lost.set()
        until(lambda: any("is back" in line for line in told))
        next(frames)
        until(lambda: manager.value(ONE, GAIN) == 100)
        until(lambda: manager.value(ONE, EXPOSURE) == 82)
        time.sleep(0.3)
    assert [line for line in told if "gain" in line] == [
        "stream: camera.gain: 500 is wanted, but the camera manager has 100; it takes 0 to 100"
    ]


def test_a_manager_that_comes_later_is_waited_for_while_pictures_flow() -> None:
    port = free_port()
    lost, told = threading.Event(), list[str]()
    opener = partial(CameraManager, ManagerAddress("127.0.0.1", port))
    keeper = Keeper(opener, {"exposure": 8.2}, "stream", told.append)
    with Live(kept(lambda: Pictures(lost), keeper), "stream", told.append) as source:
        next(iter(source))
        until(lambda: len(told) == 1)
        with Manager(ONE, port=port) as manager:
            until(lambda: len(told) == 2)
            assert manager.value(ONE, EXPOSURE) == 82
    assert told[0].startswith("stream: camera controls are not set: http://127.0.0.1:")
    assert told[1] == "stream: camera controls are set now"


def test_a_slow_manager_keeps_no_picture_back_for_long(
    manager: Manager, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keeping, "FIRST_S", 0.1)
    manager.slow_s = 1.0
    lost, told = threading.Event(), list[str]()
    begun_s = time.monotonic()
    with source_of(manager, lost, told, exposure=8.2)() as source:
        next(iter(source))
        assert time.monotonic() - begun_s < 1.0
        assert manager.value(ONE, EXPOSURE) == 156
        until(lambda: manager.value(ONE, EXPOSURE) == 82)
    assert told == []


def test_a_lock_waits_until_the_camera_has_settled_and_holds_after_a_reconnect(
    manager: Manager, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keeping, "SETTLE_S", 0.4)
    lost, told = threading.Event(), list[str]()
    with source_of(manager, lost, told, exposure="lock")() as source:
        frames = iter(source)
        next(frames)
        assert manager.value(ONE, EXPOSURE_AUTO) == 3
        manager.set(ONE, EXPOSURE, 321)  # what it finds by its first pictures
        until(lambda: manager.value(ONE, EXPOSURE_AUTO) == 1)
        assert manager.value(ONE, EXPOSURE) == 321
        time.sleep(0.3)
        manager.cameras[ONE] = usual()
        lost.set()
        until(lambda: manager.value(ONE, EXPOSURE) == 321)
        assert manager.value(ONE, EXPOSURE_AUTO) == 1


# --- the doctor ---


def test_the_doctor_tells_what_the_manager_has_and_that_it_is_away(
    manager: Manager, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(eyes, "LOOK_S", 0.2)
    lost = threading.Event()
    monkeypatch.setattr(eyes, "open_source", lambda _: Live(lambda: Pictures(lost), "stream"))
    settings = CameraSettings({"exposure": 8.2}, manager.url)
    found = {f.subject: f for f in eyes.camera("rtsp://h/x", None, settings)}
    assert found["exposure"].words == "fixed at 8.2 ms" and found["exposure"].level == "ok"
    assert "set camera.white_balance = 4600" in found["white balance"].words
    gone = CameraSettings({"exposure": 8.2}, f"http://127.0.0.1:{free_port()}")
    found = {f.subject: f for f in eyes.camera("rtsp://h/x", None, gone)}
    assert found["camera controls"].level == "warning"
    assert "does not answer" in found["camera controls"].words
    assert "see in the camera's own settings" in found["camera controls"].words
    assert "exposure" not in found
