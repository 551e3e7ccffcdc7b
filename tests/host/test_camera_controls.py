"""Exposure, gain, white balance and focus of a camera of this computer: through the kernel's own
structures, with a fake kernel under the whole program, OpenCV too."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import v4l2_camera as fake
from patience import PATIENCE_S
from v4l2_camera import Camera, Knob, usual

from chromadock.controls.base import Control, ControlsAwayError
from chromadock.controls.opening import CameraSettings
from chromadock.sources import open_source, opening
from chromadock.sources.grabber import Grabber, Shot

ONCE = """
import json, sys
from chromadock.controls.applying import Held, apply
from chromadock.controls.v4l2 import V4l2
with V4l2(sys.argv[1]) as controls:
    print(json.dumps(apply(controls, json.loads(sys.argv[2]), Held(), settled=True)))
"""

WATCH = """
import json, sys
from chromadock.controls.opening import CameraSettings
from chromadock.sources import open_source
note = lambda line: print(json.dumps(line), flush=True)
camera = CameraSettings(json.loads(sys.argv[2]))
with open_source(sys.argv[1], on_note=note, camera=camera) as source:
    for frame in source:
        print(int(frame.image.mean()), flush=True)
"""


@pytest.fixture(scope="module")
def kernel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if sys.platform != "linux" or not fake.HEADER.exists() or not shutil.which("gcc"):
        pytest.skip("no gcc with Linux's headers here")
    return fake.compiled(tmp_path_factory.mktemp("kernel"))


def applied(kernel: Path, camera: Camera, **wishes: Any) -> list[str]:
    """What is told of setting a camera once."""
    process = fake.started(kernel, camera.path.parent, "-c", ONCE, camera.path, json.dumps(wishes))
    out, error = process.communicate(timeout=PATIENCE_S)
    assert not error
    lines: list[str] = json.loads(out)
    return lines


@contextmanager
def watched(kernel: Path, source: Path, **wishes: Any) -> Iterator[Iterator[int | str]]:
    """Notes, and the brightness of each picture, of a source that runs for 30 s at most."""
    process = fake.started(kernel, source.parent, "-c", WATCH, source, json.dumps(wishes))
    assert process.stdout is not None
    longest = threading.Timer(30, process.kill)
    longest.start()
    try:
        yield (json.loads(line) for line in process.stdout)
    finally:
        longest.cancel()
        process.kill()
        process.communicate()


def until(what: Any, seconds: float = 20) -> None:
    """Wait for something to become true."""
    end_s = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end_s, "it never came"
        time.sleep(0.02)


# --- one setting ---


def test_automatics_go_off_and_values_are_set_in_the_users_units(
    kernel: Path, tmp_path: Path
) -> None:
    camera = Camera(tmp_path, 0)
    assert applied(kernel, camera, exposure=8.2, gain=40, white_balance=5000, focus=60) == []
    assert (camera[fake.EXPOSURE_AUTO], camera[fake.EXPOSURE]) == (fake.MANUAL, 82)
    assert (camera[fake.WHITE_BALANCE_AUTO], camera[fake.WHITE_BALANCE]) == (0, 5000)
    assert (camera[fake.FOCUS_AUTO], camera[fake.FOCUS], camera[fake.GAIN]) == (0, 60, 40)
    assert camera[fake.EXPOSURE_PRIORITY] == 0, "the frame rate may fall"


def test_what_is_not_wished_for_is_left_alone(kernel: Path, tmp_path: Path) -> None:
    camera = Camera(tmp_path, 0)
    assert applied(kernel, camera, gain=7) == []
    for knob in usual():
        assert camera[knob.number] == (7 if knob.number == fake.GAIN else knob.initial)


def test_automatic_is_turned_on_again(kernel: Path, tmp_path: Path) -> None:
    camera = Camera(tmp_path, 0)
    camera[fake.EXPOSURE_AUTO], camera[fake.FOCUS_AUTO] = fake.MANUAL, 0
    assert applied(kernel, camera, exposure="auto", focus="auto") == []
    assert camera[fake.EXPOSURE_AUTO] == fake.APERTURE_PRIORITY and camera[fake.FOCUS_AUTO] == 1


def test_locked_is_the_value_that_the_camera_has_found(kernel: Path, tmp_path: Path) -> None:
    camera = Camera(tmp_path, 0)
    camera[fake.EXPOSURE], camera[fake.WHITE_BALANCE] = 333, 3900
    assert applied(kernel, camera, exposure="lock", white_balance="lock", gain="lock") == []
    assert (camera[fake.EXPOSURE_AUTO], camera[fake.EXPOSURE]) == (fake.MANUAL, 333)
    assert (camera[fake.WHITE_BALANCE_AUTO], camera[fake.WHITE_BALANCE]) == (0, 3900)


@pytest.mark.parametrize(
    ("faults", "wishes", "said"),
    [
        ({}, {"exposure": 900},
         "exposure: 900 ms is wanted, but the driver has 500 ms; it takes 0.1 to 500 ms"),
        ({}, {"focus": 62},
         "focus: 62 is wanted, but the driver has 60; it takes 0 to 250 in steps of 5"),
        ({"exposure": fake.COARSE}, {"exposure": 8.2},
         "exposure: 8.2 ms is wanted, but the driver has 5 ms; it takes 0.1 to 500 ms"),
        ({"gain": fake.IGNORES}, {"gain": 40},
         "gain: 40 is wanted, but the driver has 0; it takes 0 to 100"),
        ({"gain": fake.BUSY}, {"gain": 40},
         "gain: 40 is wanted, but the driver has 0; it takes 0 to 100 (Device or resource busy)"),
        ({"gain": fake.UNREADABLE}, {"gain": 40},
         "gain: 40 was written, but cannot be read back"),
        ({"exposure_auto": fake.IGNORES}, {"exposure": 8},
         "exposure: the driver leaves it automatic (Permission denied)"),
        ({"white_balance_auto": fake.BUSY}, {"white_balance": "lock"},
         "white_balance: the driver leaves it automatic (Permission denied)"),
        ({"focus_auto": fake.UNREADABLE}, {"focus": 60},
         "focus: the driver leaves it automatic"),
        ({"exposure_priority": fake.IGNORES}, {"exposure": "auto"},
         "exposure: the driver still lowers the frame rate in dim light"),
    ],
)  # fmt: skip
def test_what_the_driver_ignored_or_rounded_is_named(
    kernel: Path, tmp_path: Path, faults: dict[str, int], wishes: dict[str, Any], said: str
) -> None:
    assert applied(kernel, Camera(tmp_path, 0, usual(**faults)), **wishes) == [f"camera.{said}"]


def test_a_camera_that_cannot_be_made_automatic_says_so(kernel: Path, tmp_path: Path) -> None:
    stuck = Camera(tmp_path, 1, usual(focus_auto=fake.IGNORES))
    stuck[fake.FOCUS_AUTO] = 0
    assert applied(kernel, stuck, focus="auto") == [
        "camera.focus: the driver does not make it automatic"
    ]


def test_controls_that_a_camera_does_not_have_are_named(kernel: Path, tmp_path: Path) -> None:
    camera = Camera(
        tmp_path,
        0,
        [
            Knob(fake.GAIN, fake.INTEGER, 0, 100, 0),
            Knob(fake.WHITE_BALANCE_AUTO, fake.BOOLEAN, 0, 1, 1),
            Knob(fake.EXPOSURE_AUTO, fake.MENU, 0, 3, 3, menu=0b1000),
        ],
    )
    assert applied(kernel, camera, focus=3, gain="auto", white_balance=5000, exposure=5) == [
        "camera.exposure: the driver leaves it automatic",
        'camera.gain: this camera has no automatic for it: write a number or "lock"',
        'camera.white_balance: this camera takes no number for it: write "lock"',
        "camera.focus: this camera has no such control: leave the key out",
    ]
    assert camera[fake.WHITE_BALANCE_AUTO] == 0


@pytest.mark.parametrize(
    ("wanted", "nearest"), [(-5, 3), (3, 3), (5.4, 3), (5.6, 8), (12, 13), (99, 13), (14, 13)]
)
def test_the_nearest_value_lies_on_a_step_within_the_range(wanted: float, nearest: int) -> None:
    assert Control(3, 3, 14, step=5).nearest(wanted) == nearest


# --- while pictures are taken ---


def brightness(exposure: int) -> int:
    """Of a picture: OpenCV takes the camera's luma for that of video, 16 to 235."""
    return round((exposure - 16) * 255 / 219)


def test_the_first_picture_is_already_exposed_as_wished(kernel: Path, tmp_path: Path) -> None:
    camera = Camera(tmp_path, 0)
    with watched(kernel, camera.path, exposure=8.2) as lines:
        first = next(lines)
    assert first == pytest.approx(brightness(82), abs=2) and brightness(156) > brightness(82) + 50


def test_a_camera_that_forgets_when_it_begins_to_send_is_set_again(
    kernel: Path, tmp_path: Path
) -> None:
    camera = Camera(tmp_path, 0, usual(exposure=fake.FORGETS, gain=fake.FORGETS))
    with watched(kernel, camera.path, exposure=8.2, gain=9) as lines:
        assert any(isinstance(line, int) and line < brightness(100) for line in lines)
        until(lambda: camera[fake.GAIN] == 9)


def test_a_camera_that_is_plugged_in_again_elsewhere_is_set_as_before(
    kernel: Path, tmp_path: Path
) -> None:
    """By its link under by-id, which leads to another device then; what is told is told once."""
    first = Camera(tmp_path, 0)
    first[fake.FOCUS] = 55
    link = tmp_path / "usb-camera-video-index0"
    link.symlink_to(first.path)
    notes = []
    with watched(kernel, link, exposure=8.2, gain=500, focus="lock") as lines:
        until(lambda: first[fake.FOCUS_AUTO] == 0)
        assert first[fake.FOCUS] == 55
        first.unplug()
        link.unlink()
        time.sleep(0.5)
        second = Camera(tmp_path, 3)
        link.symlink_to(second.path)
        until(lambda: second.pictures > 30)
        for line in lines:
            if isinstance(line, str):
                notes.append(line)
            if len(notes) == 3:
                break
        until(lambda: second[fake.GAIN] == 100)
    assert second[fake.EXPOSURE_AUTO] == fake.MANUAL and second[fake.EXPOSURE] == 82
    assert (second[fake.FOCUS_AUTO], second[fake.FOCUS]) == (0, 55)
    assert "camera.gain: 500 is wanted, but the driver has 100" in notes[0]
    assert "delivers no more frames" in notes[1] and "is back after" in notes[2]


def test_a_device_that_is_not_there_is_told_in_one_line(tmp_path: Path) -> None:
    if sys.platform != "linux":
        pytest.skip("V4L2 is Linux's")
    from chromadock.controls.v4l2 import V4l2

    with pytest.raises(ControlsAwayError, match="No such file") as away:
        V4l2(str(tmp_path / "video0"))
    assert "video0: its controls cannot be reached" in str(away.value)
    assert "\n" not in str(away.value)


# --- what is refused and what is found ---


def test_a_recording_has_no_camera_that_could_be_set(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "a.png"), np.zeros((48, 64, 3), np.uint8))
    camera = CameraSettings({"exposure": 5.0, "gain": "lock"}, "http://127.0.0.1:9")
    notes: list[str] = []
    with open_source(str(tmp_path / "a.png"), on_note=notes.append, camera=camera) as source:
        assert len(list(source)) == 1
    [note] = notes
    assert note.endswith("a.png: camera.exposure, camera.gain: no camera, so they change nothing")


def test_of_a_stream_whose_camera_nobody_sets_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    class Grey(Grabber):
        def grab(self) -> Shot | None:
            return Shot(np.zeros((4, 4, 3), np.uint8), None)

        def close(self) -> None:
            """Nothing is open."""

    monkeypatch.setattr(opening, "open_gstreamer", lambda _: Grey())
    notes: list[str] = []
    camera = CameraSettings({"exposure": 5.0})
    with open_source("v4l2src ! appsink", on_note=notes.append, camera=camera) as source:
        next(iter(source))
    [note] = notes
    assert note.startswith("pipeline: camera.exposure: nothing can be set here")
    assert "\n" not in note


def doctor(kernel: Path, camera: Camera, text: str = "") -> str:
    file = camera.path.with_suffix(".toml")
    file.write_text(f"[camera]\nsource = '{camera.path}'\n{text}")
    process = fake.started(
        kernel, camera.path.parent, "-c",
        "import sys; from chromadock.doctor.camera import camera\n"
        "from chromadock.vehicle.building import camera_settings_of\n"
        "from chromadock.vehicle.reading import read_vehicle\n"
        "from pathlib import Path\n"
        "vehicle = read_vehicle(Path(sys.argv[1]))\n"
        "for f in camera(vehicle.camera.source, None, camera_settings_of(vehicle)):\n"
        "    print(f.level, f.subject + ':', f.words)",
        file,
    )  # fmt: skip
    out, error = process.communicate(timeout=PATIENCE_S)
    assert not error
    return out


def test_the_doctor_proposes_the_values_that_the_camera_has_found(
    kernel: Path, tmp_path: Path
) -> None:
    camera = Camera(tmp_path, 0)
    camera[fake.FOCUS_AUTO] = 0
    found = doctor(kernel, camera)
    assert (
        "warning exposure: automatic, 15.6 ms now, and lowers the frame rate in dim light: "
        "set camera.exposure = 15.6"
    ) in found
    assert "warning white balance: automatic, 4600 K now: set camera.white_balance = 4600" in found
    assert "ok focus: fixed at 30; camera.focus = 30 keeps it so after a restart" in found
    assert "gain" not in found, "it follows the exposure"
    assert camera[fake.EXPOSURE_AUTO] == fake.APERTURE_PRIORITY, "the doctor only looks"


def test_the_doctor_looks_at_the_camera_as_the_vehicle_sets_it(
    kernel: Path, tmp_path: Path
) -> None:
    camera = Camera(tmp_path, 0, usual(white_balance_auto=fake.IGNORES))
    found = doctor(
        kernel, camera, 'exposure = 8.2\ngain = 12\nwhite_balance = 5000\nfocus = "lock"\n'
    )
    assert "ok exposure: fixed at 8.2 ms\n" in found
    assert "ok gain: fixed at 12\n" in found and "ok focus: fixed at 30\n" in found
    assert "warning camera controls: camera.white_balance: the driver leaves it auto" in found
    assert "warning white balance: automatic, 4600 K now" in found


def test_a_run_tells_what_the_camera_did_not_follow(kernel: Path, tmp_path: Path) -> None:
    camera = Camera(tmp_path, 0)
    (tmp_path / "v.toml").write_text(
        f"[camera]\nsource = '{camera.path}'\nwhite_balance = 4321\n[outputs]\nresults = []\n"
    )
    process = fake.started(
        kernel, tmp_path, "-m", "chromadock", "run", tmp_path / "v.toml", "--json"
    )
    assert process.stdout is not None and process.stderr is not None
    try:
        line = process.stderr.readline()
        assert re.search(r"warning: .*video0: camera.white_balance: 4321 K is wanted", line)
        assert "\n" not in line.rstrip("\n") and camera[fake.WHITE_BALANCE] == 4320
    finally:
        process.terminate()
        process.communicate()


def test_requests_are_those_of_the_kernels_header(tmp_path: Path) -> None:
    """Sizes and numbers of the requests, as the compiler has them of the kernel's header."""
    from chromadock.controls import v4l2

    if not fake.HEADER.exists() or not shutil.which("gcc"):
        pytest.skip("no gcc with Linux's headers here")
    program = tmp_path / "requests.c"
    program.write_text(
        "#include <linux/videodev2.h>\n#include <stdio.h>\n"
        'int main(void) { printf("%u %u %u %u", (unsigned)VIDIOC_G_CTRL, (unsigned)VIDIOC_S_CTRL,'
        "(unsigned)VIDIOC_QUERYCTRL, (unsigned)VIDIOC_QUERYMENU); return 0; }"
    )
    subprocess.run(["gcc", program, "-o", tmp_path / "requests"], check=True)
    out = subprocess.run([tmp_path / "requests"], capture_output=True, text=True, check=True)
    ours = (v4l2._GET, v4l2._SET, v4l2._QUERY_CONTROL, v4l2._QUERY_MENU)
    assert tuple(map(int, out.stdout.split())) == ours
