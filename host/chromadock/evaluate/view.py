"""What the vehicle works out of a frame before any filter, once for all of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from chromadock.choices import MAPPINGS
from chromadock.colour.background import BackgroundColour
from chromadock.colour.marker import SteadyHue, marker_hue
from chromadock.colour.vehicle import vehicle_background
from chromadock.paper.mask import blurred_grey


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """A frame with what the filters share.

    ``frame_bgr`` and ``hsv`` (OpenCV's) are (H, W, 3) uint8, ``grey`` (H, W) uint8 blurred;
    ``marker_hues`` has the hue expected, 0..1535, for each of ``MAPPINGS``.
    """

    frame_bgr: NDArray[np.uint8]
    hsv: MatLike
    grey: NDArray[np.uint8]
    background: BackgroundColour
    marker_hues: Mapping[str, int]


class Vehicle:
    """The vehicle's colour decision frame after frame, for every mapping at once."""

    def __init__(self) -> None:
        self._steady = {mapping: SteadyHue() for mapping in MAPPINGS}

    def decide(
        self, frame_bgr: NDArray[np.uint8], time_s: float
    ) -> tuple[BackgroundColour, dict[str, int]]:
        """Water's colour and the hue expected of the marker, as ``Detector`` finds them."""
        background = vehicle_background(frame_bgr)
        now_ms = round(time_s * 1000)
        hues = {
            mapping: steady.add(background.meaningful, marker_hue(background, mapping), now_ms)
            for mapping, steady in self._steady.items()
        }
        return background, hues

    def view(self, frame_bgr: NDArray[np.uint8], time_s: float) -> View:
        """Take the next frame, (H, W, 3) uint8 BGR."""
        background, hues = self.decide(frame_bgr, time_s)
        return View(
            frame_bgr,
            cv2.cvtColor(frame_bgr, cv2.COLOR_BGR2HSV),
            blurred_grey(frame_bgr),
            background,
            hues,
        )
