"""A web camera: Motion JPEG over HTTP, ten pictures a second for ever."""

from __future__ import annotations

import contextlib
import itertools
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import cv2
import numpy as np
from robust_composites import compose

PERIOD_S = 0.1
RANGE_M = 2.5
WATER_BGR = (150, 120, 40)


def same() -> np.random.Generator:
    """What every frame has in common: where the dock stands."""
    return np.random.default_rng(7)


def dock_frames(count: int) -> list[bytes]:
    """JPEGs of it, each with noise of its own."""
    found = []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        water = np.full((480, 640, 3), WATER_BGR, np.uint8)
        scene = compose(water, RANGE_M, same())
        noisy = scene.frame_bgr + rng.normal(0, 2, scene.frame_bgr.shape)
        ok, jpeg = cv2.imencode(".jpg", np.clip(noisy, 0, 255).astype(np.uint8))
        assert ok
        found.append(jpeg.tobytes())
    return found


@contextlib.contextmanager
def web_camera(picture: Callable[[], bytes] | None = None) -> Iterator[str]:
    """Serves what ``picture`` returns, a JPEG, each time that a picture is taken, or a dock that
    stands still; its address."""
    if picture is None:
        pictures = itertools.cycle(dock_frames(8))
        picture = partial(next, pictures)
    take = picture

    class Camera(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
            self.end_headers()
            while True:
                jpeg = take()
                head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
                try:
                    self.wfile.write(head.encode() + jpeg + b"\r\n")
                except OSError:
                    return
                time.sleep(PERIOD_S)

        def log_message(self, *_words: object) -> None:
            """Say nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Camera)
    server.daemon_threads = True
    server.block_on_close = False
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/video"
    finally:
        server.shutdown()
        server.server_close()
