"""Real streams, each from a server of somebody else's, on loopback."""

from __future__ import annotations

import itertools
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from fractions import Fraction
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from camera_manager import EXPOSURE, Manager
from picture_time import age_s
from web_camera import PERIOD_S, web_camera

from chromadock.controls.opening import CameraSettings
from chromadock.errors import ChromadockError
from chromadock.ros.mcap_bag import McapBag
from chromadock.ros.topics import IMAGE
from chromadock.sources import Source, open_source
from chromadock.sources.ros_pictures import picture

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS.parent / "tools" / "setup"))
from debian import SYSTEM_PYTHON, has_streamer  # noqa: E402

SOAK = os.environ.get("CHROMADOCK_STREAM_S")
"""`make soak` gives a minute, on a computer that has nothing else to do."""

SECONDS = float(SOAK or 5)

OLD_S = 0.15 if SOAK else 1.0
"""A queue that is read at a third of its pace is more than three seconds behind after five."""


def slowly(source: Source, seconds: float) -> np.ndarray:
    """True ages of the pictures that a detector of 10 Hz has in its hands."""
    ages, end_s = [], time.monotonic() + seconds
    for frame in source:
        ages.append(age_s(frame.image, time.monotonic()))
        time.sleep(0.1)
        if time.monotonic() > end_s:
            break
    return np.array(ages)


@pytest.fixture
def rtsp() -> Iterator[str]:
    if not has_streamer():
        pytest.skip("no GStreamer with RTSP server here")
    command = [SYSTEM_PYTHON, str(TESTS / "rtsp_server.py")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        yield f"rtsp://127.0.0.1:{server.stdout.readline().strip()}/camera"
        server.kill()


def test_an_rtsp_camera_of_30_frames_a_second_is_never_behind(rtsp: str) -> None:
    with open_source(rtsp) as source:
        ages = slowly(source, SECONDS)
        third = len(ages) // 3
        early, late = (float(np.quantile(part, 0.99)) for part in (ages[3:third], ages[-third:]))
        assert source.dropped > len(ages)
    print(f"age of the picture, 99th percentile: {early:.3f} s at first, {late:.3f} s at last")
    assert early < OLD_S and late < OLD_S


def test_the_camera_behind_an_rtsp_stream_is_set_by_its_manager(rtsp: str) -> None:
    """BlueOS's manager knows the stream by another name of its computer."""
    with Manager("/dev/video0", "/dev/video2") as manager:
        endpoint = rtsp.replace("127.0.0.1", "192.168.2.2")
        manager.streams = [
            ("rtsp://192.168.2.2:8554/other", "/dev/video0"),
            (endpoint, "/dev/video2"),
        ]
        camera = CameraSettings({"exposure": 8.2}, manager.url)
        with open_source(rtsp, camera=camera) as source:
            next(iter(source))
            assert manager.value("/dev/video2", EXPOSURE) == 82
        assert manager.value("/dev/video0", EXPOSURE) == 156


def test_the_time_of_an_rtsp_picture_is_when_it_was_taken_but_for_the_encoder(rtsp: str) -> None:
    with open_source(rtsp) as source:
        errors = []
        for frame in source:
            now_s = time.monotonic()
            told = source.now() - frame.time_s  # type: ignore[operator]
            errors.append(age_s(frame.image, now_s) - told)
            if len(errors) == 60:
                break
    # The server's encoder and sender take some 20 ms, which no stamp tells: see --delay.
    assert 0 < np.median(errors[10:]) < 0.06
    assert np.ptp(np.quantile(errors[10:], (0.05, 0.95))) < 0.04


def test_an_rtsp_server_that_is_gone_is_told_and_an_address_without_one_refused(rtsp: str) -> None:
    with pytest.raises(ChromadockError, match=r"does not open: check the address") as refused:
        open_source(rtsp.replace("rtsp://", "rtsp://me:secret@").replace("/camera", "/none"))
    assert "secret" not in str(refused.value)


class Motion(BaseHTTPRequestHandler):
    """A web camera's multipart JPEG, the oldest of all streams."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        for level in range(self.server.pictures):  # type: ignore[attr-defined]
            _, jpeg = cv2.imencode(".jpg", np.full((48, 64, 3), 40 + 2 * level, np.uint8))
            head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
            self.wfile.write(head.encode() + jpeg.tobytes() + b"\r\n")
            self.wfile.flush()
            time.sleep(0.02)

    def log_message(self, *_words: object) -> None:
        """Say nothing."""


def test_a_web_camera_that_breaks_off_is_waited_for() -> None:
    server = ThreadingHTTPServer(("127.0.0.1", 0), Motion)
    server.pictures = 40  # type: ignore[attr-defined]
    threading.Thread(target=server.serve_forever, daemon=True).start()
    lines: list[str] = []
    with open_source(
        f"http://127.0.0.1:{server.server_port}/video", on_note=lines.append
    ) as source:
        frames = []
        for frame in source:
            frames.append(frame)
            if len(lines) == 2 and len(frames) > 5:
                break
    server.shutdown()
    server.server_close()
    assert frames[0].image.shape == (48, 64, 3)
    assert "delivers no more frames" in lines[0] and "is back" in lines[1]


def test_a_web_camera_that_sends_no_stamps_has_the_times_of_arrival() -> None:
    """FFmpeg makes up 25 pictures a second, but these come ten times a second."""
    jpeg = cv2.imencode(".jpg", np.full((48, 64, 3), 90, np.uint8))[1].tobytes()
    with web_camera(lambda: jpeg) as address, open_source(address) as source:
        times, ages = [], []
        for frame in itertools.islice(source, 20):
            times.append(frame.time_s)
            ages.append(source.now() - frame.time_s)  # type: ignore[operator]
    assert np.median(np.diff(times)) == pytest.approx(PERIOD_S, rel=0.1)
    assert np.quantile(ages, 0.9) < PERIOD_S


def test_mpeg_over_udp_is_read() -> None:
    """What most video transmitters of vehicles send."""
    port, stop = 20000 + os.getpid() % 20000, threading.Event()

    def send() -> None:
        with av.open(f"udp://127.0.0.1:{port}", "w", format="mpegts") as out:
            video = out.add_stream("mpeg2video", rate=30)
            video.width, video.height, video.pix_fmt, video.gop_size = 320, 240, "yuv420p", 5
            for k in range(3000):
                image = np.full((240, 320, 3), k % 200, np.uint8)
                frame = av.VideoFrame.from_ndarray(image, "bgr24")
                frame.pts, frame.time_base = k, Fraction(1, 30)
                out.mux(video.encode(frame))
                if stop.wait(1 / 30):
                    return

    sender = threading.Thread(target=send, daemon=True)
    sender.start()
    with open_source(f"udp://127.0.0.1:{port}") as source:
        frames = [frame for frame, _ in zip(source, range(20), strict=False)]
    stop.set()
    sender.join()
    assert all(frame.image.shape == (240, 320, 3) for frame in frames)
    assert (np.diff([frame.time_s for frame in frames]) > 0).all()
    assert frames[-1].image.mean() > frames[0].image.mean()


def test_a_recording_of_a_camera_has_the_wall_clock_at_capture(rtsp: str, tmp_path: Path) -> None:
    """The pictures themselves tell when they were taken."""
    dive = tmp_path / "dive.mcap"
    monotonic_to_wall_s = time.time() - time.monotonic()
    command = [sys.executable, "-m", "chromadock", "detect", rtsp, "--record", str(dive)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        for _ in range(15):
            run.stdout.readline()
        run.send_signal(signal.SIGINT)
        run.stdout.read()
        assert run.wait() == 130
    off = []
    with McapBag(dive) as bag:
        for _, message in bag.messages(IMAGE):
            stamp_s = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
            off.append(age_s(picture(message, "frame"), stamp_s - monotonic_to_wall_s))
    assert len(off) >= 14
    assert abs(np.median(off)) < OLD_S
