"""A web camera before a dock that stands still: multipart JPEG over HTTP, ten pictures a second."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import cv2
import numpy as np
from robust_composites import compose

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


class _Camera(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        pictures: list[bytes] = self.server.pictures  # type: ignore[attr-defined]
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        k = 0
        while True:
            jpeg = pictures[k % len(pictures)]
            head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
            try:
                self.wfile.write(head.encode() + jpeg + b"\r\n")
            except OSError:
                return
            k += 1
            time.sleep(0.1)

    def log_message(self, *_words: object) -> None:
        """Say nothing."""


@contextmanager
def web_camera(pictures: list[bytes] | None = None) -> Iterator[str]:
    """Its URL."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Camera)
    server.pictures = pictures or dock_frames(8)  # type: ignore[attr-defined]
    server.daemon_threads = True
    server.block_on_close = False
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/video"
    server.shutdown()
    server.server_close()
