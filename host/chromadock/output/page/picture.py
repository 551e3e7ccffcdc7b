"""The newest frame with what was found in it, as a JPEG."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import cv2

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.output.page.status import Newest
from chromadock.output.run_setup import RunSetup
from chromadock.overlay import draw_seen
from chromadock.vehicle.building import dock_of

PERIOD_S = 0.2
"""However many clients ask, so often at most is one drawn: the detection has the processor."""
_QUALITY = 80


class Picture:
    """Draws when somebody asks, and for all of them once.

    Parameters
    ----------
    now : the monotonic clock, seconds.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._one_draws = threading.Lock()
        self._drawn: Newest | None = None
        self._drawn_s = 0.0
        self._jpeg = b""
        self._setup: RunSetup | None = None
        self._dock = DockGeometry.default()

    def jpeg(self, newest: Newest, setup: RunSetup | None) -> bytes:
        """The picture of ``newest``, or the one that was drawn a moment ago."""
        with self._one_draws:
            fresh = self._now() - self._drawn_s < PERIOD_S
            if self._drawn is None or (newest is not self._drawn and not fresh):
                if setup is not self._setup and setup is not None:
                    self._setup, self._dock = setup, dock_of(setup.settings, confirmed=True)
                self._jpeg = _drawn(newest, None if setup is None else setup.camera, self._dock)
                self._drawn, self._drawn_s = newest, self._now()
            return self._jpeg


def _drawn(newest: Newest, camera: CameraModel | None, dock: DockGeometry) -> bytes:
    image = newest.frame.image
    camera = camera or CameraModel.nominal(image.shape[1], image.shape[0])
    picture = draw_seen(image, newest.detection, camera, dock)
    _, jpeg = cv2.imencode(".jpg", picture, (cv2.IMWRITE_JPEG_QUALITY, _QUALITY))
    return jpeg.tobytes()
