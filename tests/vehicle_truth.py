"""Synthetic truth for tests of the track: a vehicle that yaws, its telemetry, and its camera."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from track_truth import CAMERA, DOCK, NOTHING, Pose, found, rotation

from chromadock import Attitude, Tracker
from chromadock.mounting import R_BODY_CAMERA_FORWARD
from chromadock.results.track import TrackedPose
from chromadock.rotation import matrix_from_quaternion

IN_95_PERCENT = 12.59  # chi-square with six degrees of freedom
PREDICTED_S = 0.15

Telemetry = Callable[[float], Attitude | None]


@dataclass(frozen=True)
class Yawing:
    """Ahead of the dock at 0.1 m/s, yawing as a sine; pitching and rolling by 2 degrees."""

    yaw_deg: float
    period_s: float
    phase_rad: float = 0.0

    def angles_deg(self, time_s: float) -> np.ndarray:
        yaw = self.yaw_deg * np.sin(2 * np.pi * time_s / self.period_s + self.phase_rad)
        pitch, roll = (2 * np.sin(2 * np.pi * time_s / period_s) for period_s in (3.1, 2.7))
        return np.array([roll, pitch, yaw])

    def pose(self, time_s: float) -> Pose:
        roll, pitch, yaw = np.radians(self.angles_deg(time_s))
        R_camera_world = (Attitude(roll, pitch, yaw).R_world_body @ R_BODY_CAMERA_FORWARD).T
        place = np.array([3.0 - 0.1 * time_s, 0.05, 0.1])
        R_world_dock = R_BODY_CAMERA_FORWARD @ rotation(0, 10)
        return R_camera_world @ R_world_dock, R_camera_world @ place


def telemetry(vehicle: Yawing, rate_hz: float, step_deg: float = 0.0) -> Telemetry:
    """The last of readings with 0.1 degrees of noise, in steps, as a driver hands it out."""
    rng, held, due_s = np.random.default_rng(11), list[Attitude](), [0.0]

    def read(time_s: float) -> Attitude:
        if time_s >= due_s[0] - 1e-9:
            angles = vehicle.angles_deg(time_s) + rng.normal(0, 0.1, 3)
            if step_deg:
                angles = np.round(angles / step_deg) * step_deg
            held[:] = [Attitude(*np.radians(angles))]
            due_s[0] += 1 / rate_hz
        return held[0]

    return read


@dataclass(frozen=True)
class Outcome:
    """Of the frames after the first two seconds, (N,) each: whether there was a pose; whether the
    true one was in its 95% region; how far off it was, metres; both of PREDICTED_S later."""

    tracked: np.ndarray
    covered: np.ndarray
    off_m: np.ndarray
    predicted_covered: np.ndarray
    predicted_off_m: np.ndarray


def judged(pose: TrackedPose, truth: Pose) -> tuple[bool, float]:
    """Whether the truth is in a tracked pose's 95% region; metres that it is off."""
    turn = cv2.Rodrigues(truth[0] @ matrix_from_quaternion(pose.q_wxyz).T)[0].ravel()
    off = np.concatenate([truth[1] - np.array(pose.t), turn])
    square = float(off @ np.linalg.solve(np.reshape(pose.covariance, (6, 6)), off))
    return square < IN_95_PERCENT, float(np.linalg.norm(off[:3]))


def followed(
    vehicle: Yawing, hz: float, seconds: float, attitude: Telemetry | None, seed: int = 0
) -> Outcome:
    """A tracker on a vehicle; a search about priors finds the dock within their reach only."""
    tracker, rng = Tracker(DOCK), np.random.default_rng(seed)
    rows: list[tuple[bool, bool, float, bool, float]] = []
    for k in range(round(seconds * hz)):
        time_s = k / hz
        pose, plan = vehicle.pose(time_s), tracker.plan(time_s)
        reached = plan.everywhere or any(p.distance(*pose) < 25 for p in plan.priors)
        seen = found(pose, rng) if reached else NOTHING
        told = None if attitude is None else attitude(time_s)
        track = tracker.update(time_s, plan, seen, CAMERA, told)
        if time_s < 2:
            continue
        later = tracker.at(time_s + PREDICTED_S)
        if track.pose is None or later.pose is None:
            rows.append((False, False, np.nan, False, np.nan))
            continue
        truth = vehicle.pose(time_s + PREDICTED_S)
        rows.append((True, *judged(track.pose, pose), *judged(later.pose, truth)))
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    return Outcome(*columns)
