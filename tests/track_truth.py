"""Synthetic truth for tests of the track: a dock, a moving camera, and what it would measure."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.pose import Sighting, estimates
from chromadock.look import Found
from chromadock.track.candidate import LOCK_EVIDENCE
from chromadock.track.sight import Sight

CAMERA = CameraModel.nominal(640, 480)
DOCK = DockGeometry.default()
NOISE_PX = 0.3

Pose = tuple[np.ndarray, np.ndarray]


def rotation(pitch_deg: float, yaw_deg: float, roll_deg: float = 0.0) -> np.ndarray:
    R = np.eye(3)
    for axis, angle in enumerate((pitch_deg, yaw_deg, roll_deg)):
        R = R @ cv2.Rodrigues(np.eye(3)[axis] * np.radians(angle))[0]
    return R


def approach(time_s: float) -> Pose:
    """From 5 m on at half a metre a second, off the axis, turning slowly."""
    R = rotation(3 * np.sin(time_s), 12 + 2 * time_s, 2 * np.cos(time_s))
    return R, np.array([0.3 - 0.05 * time_s, 0.1, 5.0 - 0.5 * time_s])


def pixels(pose: Pose, rng: np.random.Generator, names: tuple[str, ...] = DOCK.names) -> np.ndarray:
    points = DOCK.points[[DOCK.names.index(n) for n in names]]
    seen = CAMERA.project(points @ pose[0].T + pose[1])
    return seen + rng.normal(0, NOISE_PX, seen.shape)


def found(
    pose: Pose,
    rng: np.random.Generator,
    evidence: float = LOCK_EVIDENCE + 1.5,
    names: tuple[str, ...] = DOCK.names,
) -> Found:
    """What a method would report; its noise is that of the pixels."""
    at = pixels(pose, rng, names)
    points = DOCK.points[[DOCK.names.index(n) for n in names]]
    poses = estimates(Sighting(points, at, np.full(len(at), NOISE_PX), CAMERA))
    return Found(
        state="found" if len(names) == len(DOCK.names) else "partial",
        passed_fraction=0.0,
        markers={n: (float(x), float(y)) for n, (x, y) in zip(names, at, strict=True)},
        pose=poses[0].pose(),
        estimates=poses,
        evidence=evidence,
        sigma_px=(NOISE_PX,) * len(at),
    )


def sight(pose: Pose, rng: np.random.Generator, names: tuple[str, ...] = DOCK.names) -> Sight:
    what = found(pose, rng, names=names)
    assert what.markers is not None
    made = Sight.of(what.markers, what.sigma_px, what.estimates, DOCK, CAMERA)
    assert made is not None
    return made


NOTHING = Found("not_found", 0.0)

Course = Callable[[float], Pose]
