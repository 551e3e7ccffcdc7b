"""What is kept of each frame of the demo, and how far it is from the truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from chromadock.colour.hsv import rgb_from_hsv
from chromadock.demo.loop import Moment
from chromadock.method import HUE_RANGE
from chromadock.results.detection import Detection
from chromadock.rotation import matrix_from_quaternion
from chromadock.sim.truth import Truth


@dataclass(frozen=True, slots=True)
class Record:
    """One frame without its pixels."""

    index: int
    time_s: float
    place: str
    detection: Detection
    dock_hue_deg: float
    truth: Truth

    @classmethod
    def of(cls, moment: Moment) -> Record:
        """The part of a moment worth keeping."""
        return cls(
            moment.index,
            moment.time_s,
            moment.place,
            moment.detection,
            moment.step.dock_hue_deg,
            moment.frame.truth,
        )

    @property
    def dock_rgb(self) -> tuple[int, int, int]:
        """The pure colour that the dock decided on."""
        return rgb_from_hsv(round(self.dock_hue_deg * HUE_RANGE / 360) % HUE_RANGE, 255, 255)

    @property
    def true_range_m(self) -> float:
        """Distance of the dock from the camera."""
        return self.truth.range_m

    @property
    def range_m(self) -> float | None:
        """The same as measured; None where neither the dock nor most of it was found."""
        pose = self.detection.pose
        return None if pose is None else float(np.linalg.norm(pose.t))

    @property
    def position_error_m(self) -> float | None:
        """Distance between measured and true position."""
        pose, truth = self.detection.pose, self.truth.T_camera_dock.t
        return None if pose is None else float(np.linalg.norm(np.array(pose.t) - truth))

    @property
    def attitude_error_deg(self) -> float | None:
        """Angle between measured and true attitude."""
        pose = self.detection.pose
        if pose is None:
            return None
        difference = matrix_from_quaternion(pose.q_wxyz) @ self.truth.T_camera_dock.R.T
        cosine = (np.trace(difference) - 1) / 2
        return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))

    @property
    def hue_disagreement_deg(self) -> float:
        """How far dock and vehicle are apart on the marker's hue."""
        expected_deg = self.detection.marker.hue_deg
        assert expected_deg is not None, "the demo's vehicle expects a hue"
        apart = abs(self.dock_hue_deg - expected_deg) % 360
        return min(apart, 360 - apart)

    def to_dict(self) -> dict[str, Any]:
        """The detection's JSON object with the dock's hue and the truth beside it."""
        return {
            **self.detection.to_dict(),
            "frame": self.index,
            "time_s": round(self.time_s, 3),
            "place": self.place,
            "dock": {"hue_deg": round(self.dock_hue_deg, 2)},
            "truth": self.truth.to_dict(),
        }
