"""Pictures of approaches: frames with a wrong pose, and near ones in which nothing is tracked."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from approaches_frames import Seen

from chromadock import Detection
from chromadock.rotation import matrix_from_quaternion
from chromadock.variety import Moment, Truth

NEAR_M = 4.0
"""Frames that show the dock nearer than this and in which it is not tracked are kept."""

KEPT = 3
"""Pictures of each kind and run."""

APART_S = 0.5
"""Between two pictures of a kind: the next frame looks the same."""

WHITE, BLACK, YELLOW = (255, 255, 255), (0, 0, 0), (0, 255, 255)


class Pictures:
    """Writes those of one run to a folder; nothing without a folder."""

    def __init__(self, folder: Path | None, name: str) -> None:
        self._folder, self._name = folder, name
        self._last: dict[str, float] = {}
        self._kept: dict[str, int] = {}

    def add(self, moment: Moment, detection: Detection, seen: Seen) -> None:
        """Keep the frame if it is one of the first that went wrong."""
        kind = "wrong" if seen.wrong else None
        if kind is None and seen.shown and seen.distance_m < NEAR_M and not seen.tracked:
            kind = "untracked"
        if self._folder is None or kind is None:
            return
        since_s = moment.time_s - self._last.get(kind, -np.inf)
        if since_s < APART_S or self._kept.get(kind, 0) >= KEPT:
            return
        self._last[kind], self._kept[kind] = moment.time_s, self._kept.get(kind, 0) + 1
        file = self._folder / f"{self._name}-{kind}-{moment.time_s:04.1f}.png"
        cv2.imwrite(str(file), marked(moment, detection, seen))


def marked(moment: Moment, detection: Detection, seen: Seen) -> np.ndarray:
    """The frame with the true markers ringed white, the found ones black, the track's yellow."""
    shown, truth = moment.frame_bgr.copy(), moment.truth
    found = np.array(list((detection.markers or {}).values()), np.float64).reshape(-1, 2)
    for pixels, radius, colour in (
        (truth.pixels, 14, WHITE),
        (found, 11, BLACK),
        (_tracked(detection, truth), 8, YELLOW),
    ):
        for x, y in pixels:
            centre = (round(16 * x), round(16 * y))
            cv2.circle(shown, centre, 16 * radius, colour, 1, cv2.LINE_AA, 4)
    off = "" if seen.error is None else f" {100 * seen.error:.0f} % off"
    evidence = "" if seen.evidence is None else f" {seen.evidence:.1f} decades"
    words = f"{seen.distance_m:.1f} m, {seen.state}{off}, frame: {seen.single}{evidence}"
    cv2.putText(shown, words, (6, shown.shape[0] - 8), 0, 0.45, WHITE, 1, cv2.LINE_AA)
    return shown


def _tracked(detection: Detection, truth: Truth) -> np.ndarray:
    """(N, 2) pixels of the markers by the track's pose; none without one."""
    pose = None if detection.track is None else detection.track.pose
    if pose is None or truth.dock is None:
        return np.empty((0, 2))
    places = truth.dock.points @ matrix_from_quaternion(pose.q_wxyz).T + pose.t
    return truth.camera.project(places) if (places[:, 2] > 0.05).all() else np.empty((0, 2))
