"""Live sources: the newest picture wins, times are of capture, what went away is waited for."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from chromadock.errors import ChromadockError
from chromadock.sources import live
from chromadock.sources.capture_time import CaptureTime
from chromadock.sources.grabber import Grabber, Shot
from chromadock.sources.live import Live

PERIOD_S = 0.01


class Camera(Grabber):
    """A camera of 100 Hz, each picture of which shows its number, and is late by ``late_s``."""

    fps = 1 / PERIOD_S
    monotonic = True

    def __init__(self, pictures: int | None = None, late_s: float = 0.02) -> None:
        self._left = pictures
        self._late_s = late_s
        self._begun_s = time.monotonic()
        self._number = 0
        self.closed = False

    def grab(self) -> Shot | None:
        if self._left == 0:
            return None
        if self._left is not None:
            self._left -= 1
        taken_s = self._begun_s + PERIOD_S * self._number
        time.sleep(max(0.0, taken_s + self._late_s - time.monotonic()))
        image = np.full((4, 4, 3), self._number % 256, np.uint8)
        self._number += 1
        return Shot(image, taken_s)

    def close(self) -> None:
        self.closed = True


def test_who_is_slower_than_the_camera_gets_its_newest_picture_with_the_time_of_its_capture() -> (
    None
):
    """What is read at 10 Hz of 100 Hz is never the queue of a second ago."""
    with Live(Camera, "camera") as source:
        ages, indices = [], []
        for frame in source:
            ages.append(source.now() - frame.time_s)
            assert frame.image[0, 0, 0] == frame.index % 256
            indices.append(frame.index)
            if len(indices) == 10:
                break
            time.sleep(0.1)
    # Late by 0.02 s, and the newest when it was asked for; a busy computer gets as much again.
    assert np.median(ages) == pytest.approx(0.025, abs=0.02)
    assert indices[-1] > 60
    assert source.dropped >= indices[-1] - len(indices)


def test_a_source_that_goes_away_is_opened_again_and_both_is_told_once() -> None:
    cameras = [Camera(3), ChromadockError("busy"), Camera(None)]
    opened: list[Camera] = []

    def open_next() -> Camera:
        next_one = cameras.pop(0)
        if isinstance(next_one, ChromadockError):
            raise next_one
        opened.append(next_one)
        return next_one

    lines: list[str] = []
    with Live(open_next, "camera 0", lines.append) as source:
        times = []
        for frame in source:
            times.append(frame.time_s)
            if times[-1] - times[0] > 1.6:  # after waits of half a second and a second
                break
    assert lines[0] == "camera 0: delivers no more frames: waiting until it is back"
    assert lines[1].startswith("camera 0: is back after 1.5") and len(lines) == 2
    assert [camera.closed for camera in opened] == [True, True]
    assert (np.diff(times) > 0).all()


def test_a_source_that_is_not_there_at_first_is_a_fault() -> None:
    def nothing() -> Grabber:
        raise ChromadockError("camera 7: does not open")

    with pytest.raises(ChromadockError, match="camera 7"):
        Live(nothing, "camera 7")


def test_what_breaks_in_the_thread_is_raised_where_frames_are_asked_for() -> None:
    class Broken(Camera):
        def grab(self) -> Shot | None:
            raise MemoryError("no memory")

    with Live(Broken, "camera") as source, pytest.raises(MemoryError):
        next(iter(source))


def test_a_camera_that_hangs_is_not_closed_under_the_hands_of_its_reader(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(live, "_STOP_S", 0.05)
    go_on = threading.Event()
    cameras: list[Camera] = []

    class Hanging(Camera):
        def grab(self) -> Shot | None:
            go_on.wait(10)
            return None

    def opened() -> Camera:
        cameras.append(Hanging())
        return cameras[-1]

    source = Live(opened, "camera")
    threading.Thread(target=lambda: list(source), daemon=True).start()
    time.sleep(0.1)
    source.close()
    assert not cameras[0].closed
    go_on.set()


# --- the time of capture ---


def lateness(stamps: Callable[[int], float], late: list[float], clock: CaptureTime) -> np.ndarray:
    """By how much each time is after the capture, of pictures every 33 ms."""
    taken = [100.0 + k / 30 for k in range(len(late))]
    told = [clock.of(stamps(k), taken[k] + late[k]) for k in range(len(late))]
    return np.array(told) - taken


def test_a_drivers_stamp_is_the_time_of_capture() -> None:
    late = [0.03, 0.2, 0.05]
    assert lateness(lambda k: 100.0 + k / 30, late, CaptureTime(True)) == pytest.approx([0, 0, 0])


def test_a_driver_whose_stamps_are_of_another_clock_is_not_believed_blindly() -> None:
    """Of the time of day, say: then the quickest arrival tells how far the clocks are apart."""
    late = [0.03, 0.2, 0.05]
    told = lateness(lambda k: 1.7e9 + k / 30, late, CaptureTime(True))
    assert told == pytest.approx([0.03] * 3, abs=1e-6)


def test_a_streams_pictures_are_as_late_as_the_quickest_of_them_less_the_stated_delay() -> None:
    rng = np.random.default_rng(0)
    late = list(0.08 + rng.exponential(0.05, 200))
    told = lateness(lambda k: 7.0 + k / 30, late, CaptureTime(False, delay_s=0.08))
    assert np.abs(told[20:]).max() < 0.01


def test_the_clocks_may_drift_apart() -> None:
    """By 100 parts in a million: after an hour 0.36 s; in the window of a hundred 0.3 ms."""
    pictures = 30 * 3600
    clock = CaptureTime(False)
    last = 0.0
    for k in range(pictures):
        taken_s = k / 30
        last = clock.of(taken_s * 0.9999, taken_s + 0.02 + 0.01 * (k % 70 == 0)) - taken_s
    assert last == pytest.approx(0.02, abs=1e-3)


def test_stamps_that_begin_anew_are_taken_for_a_new_clock() -> None:
    """A stream's begin at zero again when its server is started anew."""
    clock = CaptureTime(False)
    assert clock.of(500.0, 10.0) == 10.0
    assert clock.of(0.0, 10.5) == 10.5
    assert clock.of(0.1, 10.61) == pytest.approx(10.6)


@given(
    st.lists(st.tuples(st.none() | st.floats(-1e9, 1e9), st.floats(0, 5)), min_size=2, max_size=40),
    st.booleans(),
    st.floats(0, 2),
)
def test_times_grow_whatever_the_stamps(
    pictures: list[tuple[float | None, float]], monotonic: bool, delay_s: float
) -> None:
    clock, arrival_s, told = CaptureTime(monotonic, delay_s), 50.0, []
    for stamp_s, later_s in pictures:
        arrival_s += later_s
        told.append(clock.of(stamp_s, arrival_s))
    assert (np.diff(told) > 0).all()
