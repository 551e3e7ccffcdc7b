"""Approaches to the dock in the simulator, with the track on: one row a frame.

Both sides run: the dock's colour is the firmware core's, the vehicle's side is ``Detector``.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import polars as pl
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from chromadock import Detector, Track
from chromadock.processors import processors
from chromadock.results.track import TrackedPose
from chromadock.rotation import matrix_from_quaternion
from chromadock.sim.scene import Scene, load_scene
from chromadock.sim.simulation import Simulation
from chromadock.sim.truth import Truth
from chromadock.toml_file import one_line_error, read_toml

SCENARIOS = Path(__file__).resolve().parents[1] / "experiments" / "approach" / "scenarios.toml"

IN_95_PERCENT = 12.59
"""Chi-square with six degrees of freedom."""

NEEDED = 3
"""Markers that a pose needs.  A row's ``contrast`` is that of the one next to be lost: its
unscattered light over the water's, in its best channel."""

_SETTINGS = dict[str, Any]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class _Scenario(_Model):
    name: str
    set: _SETTINGS = {}
    in_: dict[str, _SETTINGS] = Field(default={}, alias="in")


class _File(_Model):
    seconds: float
    rate_hz: float
    scenes: list[str]
    set: _SETTINGS = {}
    scenario: list[_Scenario]


@dataclass(frozen=True)
class Approach:
    """One run: ``changes`` of a shipped scene, one after the other."""

    scenario: str
    scene_name: str
    changes: Sequence[Mapping[str, Any]]
    times: Sequence[float]

    def scene(self) -> Scene:
        """The scene with all changes."""
        return load_scene(self.scene_name, self.changes)


def read_approaches(path: Path) -> list[Approach]:
    """The runs of a file such as experiments/approach/scenarios.toml, scene by scene.

    Raises:
        ChromadockError: one line with the file, the key and what is wrong.
    """
    content = read_toml(path, "give the scenarios of an approach")
    try:
        file = _File.model_validate(content)
    except ValidationError as error:
        raise one_line_error(str(path), error) from None
    times = [i / file.rate_hz for i in range(round(file.seconds * file.rate_hz) + 1)]
    return [
        Approach(each.name, scene, (file.set, each.set, each.in_.get(scene, {})), times)
        for scene in file.scenes
        for each in file.scenario
    ]


def run_all(approaches: Sequence[Approach]) -> pl.DataFrame:
    """All of them, one a process at a time; the same in any number of processes."""
    context = multiprocessing.get_context("spawn")  # OpenCV's threads do not survive a fork
    # Children load numpy anew: without threads of its own, of which there would be too many.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with ProcessPoolExecutor(processors(), context) as pool:
        return pl.concat(pool.map(run, approaches))


def run(approach: Approach) -> pl.DataFrame:
    """One row a frame of one approach."""
    cv2.setNumThreads(1)
    return pl.DataFrame(list(_rows(approach)), infer_schema_length=None)


def _rows(approach: Approach) -> Iterator[dict[str, Any]]:
    scene = approach.scene()
    simulation = Simulation(scene)
    detector = Detector(scene.vehicle_camera.model, scene.dock, mounting=scene.mounting)
    for step in simulation.steps(approach.times):
        frame = simulation.frame(step)
        detection = detector.process(frame.image_bgr, step.time_s)
        assert detection.track is not None
        markers = frame.truth.markers
        yield {
            "scene": approach.scene_name,
            "scenario": approach.scenario,
            "time_s": step.time_s,
            "range_m": frame.truth.range_m,
            "markers_seen": sum(marker.seen for marker in markers),
            "contrast": sorted(max(m.contrast) if m.seen else 0.0 for m in markers)[-NEEDED],
            "frame_state": detection.state,
            "state": detection.track.state,
            "measured": detection.track.age_s == 0,
            **_errors(detection.track, frame.truth, scene),
        }


def _errors(track: Track, truth: Truth, scene: Scene) -> dict[str, float | bool | None]:
    """How far off the track is, where it has a pose.

    ``marker_px``: the worst marker's distance in the image; ``place_m`` and ``attitude_deg`` of
    the pose; ``within_95``: the truth is in the 95% region of the pose or its alternative.
    """
    if track.pose is None:
        names = ("marker_px", "place_m", "attitude_deg", "within_95")
        return dict.fromkeys(names)
    R = matrix_from_quaternion(track.pose.q_wxyz)
    t = np.array(track.pose.t)
    T = truth.T_camera_dock
    camera = scene.vehicle_camera.model
    off = camera.project(scene.dock.points @ R.T + t) - camera.project(T.points(scene.dock.points))
    turn = cv2.Rodrigues(T.R @ R.T)[0]
    poses = [pose for pose in (track.pose, track.alternative) if pose is not None]
    return {
        "marker_px": float(np.linalg.norm(off, axis=1).max()),
        "place_m": float(np.linalg.norm(T.t - t)),
        "attitude_deg": float(np.degrees(np.linalg.norm(turn))),
        "within_95": any(_mahalanobis(pose, truth) < IN_95_PERCENT for pose in poses),
    }


def _mahalanobis(pose: TrackedPose, truth: Truth) -> float:
    """Squared distance of the true pose in standard deviations."""
    T = truth.T_camera_dock
    turn = cv2.Rodrigues(T.R @ matrix_from_quaternion(pose.q_wxyz).T)[0].ravel()
    off = np.concatenate([T.t - np.array(pose.t), turn])
    return float(off @ np.linalg.solve(np.array(pose.covariance).reshape(6, 6), off))
