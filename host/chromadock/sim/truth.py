"""What is true of a frame, to hold against what is found in it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.rotation import quaternion_from_matrix
from chromadock.sim.control import CameraSettings
from chromadock.sim.sensor import Sensor, tone_curve
from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class MarkerTruth:
    """One marker.

    Parameters
    ----------
    name
        As in the dock's geometry.
    pixel
        Where its middle is at the time of its own row; None behind the camera.
    range_m
        From the camera.
    in_view
        Its middle is in the image.
    visible
        Share of its face that no body hides, 0..1.
    lit
        Its lamp works and the dock drives it.
    contrast
        Unscattered light at its middle over the water's light, R, G, B; 0 where hidden or dark.
    """

    name: str
    pixel: tuple[float, float] | None
    range_m: float
    in_view: bool
    visible: float
    lit: bool
    contrast: tuple[float, float, float]

    @property
    def seen(self) -> bool:
        """It could be found: lit, in the image, and not half hidden."""
        return self.lit and self.in_view and self.visible > 0.5

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "pixel": None if self.pixel is None else [round(v, 3) for v in self.pixel],
            "range_m": round(self.range_m, 5),
            "in_view": self.in_view,
            "visible": round(self.visible, 3),
            "lit": self.lit,
            "contrast": [_significant(v) for v in self.contrast],
        }


@dataclass(frozen=True, eq=False)
class Truth:
    """One frame of the vehicle's or the dock's camera.

    Parameters
    ----------
    index, time_s
        Of the frame; under a rolling shutter, of its middle row.
    T_camera_dock
        The dock in the camera's frame at ``time_s``.
    depth_m, heading_deg
        Of the camera: below the mean surface; where it looks, from north by east.
    markers
        In the order of the dock's geometry; empty for the dock's own camera.
    water_signal
        (3,) mean light of the water over the image, cd/m^2 of daylight.
    water_rgb
        That light in the finished picture, without noise, 0..255.
    led_share
        (3,) what the LEDs give, share of full power, R, G, B.
    settings
        The camera's.
    flicker
        The waves' focusing at the camera: a standard normal variable.
    clear_share
        Share of a clear sky's illuminance that clouds leave.
    photograph
        The background's file name; None where the water is rendered.
    """

    index: int
    time_s: float
    T_camera_dock: Transform
    depth_m: float
    heading_deg: float
    markers: tuple[MarkerTruth, ...]
    water_signal: Floats
    water_rgb: tuple[int, int, int]
    led_share: Floats
    settings: CameraSettings
    flicker: float
    clear_share: float
    photograph: str | None = None

    @property
    def q_wxyz(self) -> tuple[float, float, float, float]:
        """Unit quaternion that turns dock axes into camera axes."""
        return quaternion_from_matrix(self.T_camera_dock.R)

    @property
    def range_m(self) -> float:
        """From the camera to the dock's origin."""
        return float(np.linalg.norm(self.T_camera_dock.t))

    def pixels(self) -> Floats:
        """(N, 2) the markers' places in the image, NaN behind the camera."""
        nowhere = (math.nan, math.nan)
        return np.array([marker.pixel or nowhere for marker in self.markers]).reshape(-1, 2)

    def to_dict(self) -> dict[str, Any]:
        """A line of ``truth.jsonl``."""
        return {
            "frame": self.index,
            "time_s": round(self.time_s, 6),
            "T_camera_dock": {
                "t": [round(v, 6) for v in self.T_camera_dock.t.tolist()],
                "q_wxyz": [round(v, 8) for v in self.q_wxyz],
            },
            "camera": {
                "depth_m": round(self.depth_m, 4),
                "heading_deg": round(self.heading_deg, 3),
                "exposure_s": _significant(self.settings.exposure_s),
                "gain": _significant(self.settings.gain),
                "white_balance": [_significant(v) for v in self.settings.white_balance],
            },
            "markers": {marker.name: marker.to_dict() for marker in self.markers},
            "water": {
                "signal_cd_m2": [_significant(v) for v in self.water_signal.tolist()],
                "rgb": list(self.water_rgb),
                "photograph": self.photograph,
            },
            "led_share": [round(v, 4) for v in self.led_share.tolist()],
            "flicker": round(self.flicker, 3),
            "clear_share": round(self.clear_share, 4),
        }


def colour_of(signal: Floats, sensor: Sensor, settings: CameraSettings) -> tuple[int, int, int]:
    """The R, G, B, 0..255, that even light (3,) becomes in a camera's picture, without noise."""
    raw = np.minimum(signal * sensor.response.daylight_raw * sensor.level(settings), 1)
    balanced = np.minimum(raw * settings.white_balance, 1)
    linear = np.clip(sensor.colour_matrix @ balanced, 0, 1)
    curve = tone_curve(sensor.gamma)
    red, green, blue = curve[np.rint(linear * (len(curve) - 1)).astype(int)].tolist()
    return red, green, blue


def _significant(value: float) -> float:
    return float(f"{value:.5g}")
