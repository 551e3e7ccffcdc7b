"""What one filter made of one frame, against the truth."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.evaluate.target import Target
from chromadock.look import Found
from chromadock.results.pose import Pose
from chromadock.robust.weigh.acceptance import PLACE_TOLERANCE
from chromadock.rotation import matrix_from_quaternion

CORRECT_PX = 3.0
"""All four markers at most this far from their true places: the dock is found correctly."""


def measured(found: Found, mask: NDArray[np.uint8], target: Target) -> dict[str, Any]:
    """A row's columns from ``passed`` to ``attitude_error_deg``.

    Shares of pixels passed, in all and outside the true markers' circles; whether a dock was
    found, correctly, or where there is none: a marker outside its true one's circle; whether a pose
    was told that is wrong: of such a dock, or its place off by more than ``PLACE_TOLERANCE``.  The
    errors are None where the dock was not found correctly: range relative to the true one and
    positive where too far, the angle between measured and true direction, and that between
    measured and true attitude.
    """
    passed = np.count_nonzero(mask)
    inside = np.count_nonzero(mask & target.circles(mask.shape))
    apart = _distances(found, target)
    correct = apart is not None and float(apart.max()) <= CORRECT_PX
    missed = max(CORRECT_PX, target.radius_px)
    false_dock = apart is not None and float(apart.max()) > missed
    return {
        "passed": passed / mask.size,
        "passed_outside": (passed - inside) / mask.size,
        "found": apart is not None,
        "correct": correct,
        "false_dock": false_dock,
        "wrong_pose": found.pose is not None and (false_dock or _misplaced(found.pose, target)),
        "range_true_m": target.range_m,
        **_errors(found.pose if correct else None, target),
    }


def _distances(found: Found, target: Target) -> NDArray[np.float64] | None:
    """(N,) pixels between each marker and its true place; None where no dock was found."""
    if found.markers is None:
        return None
    places = np.array([found.markers[name] for name in target.names])
    return np.asarray(np.linalg.norm(places - target.pixels, axis=1))


def _misplaced(pose: Pose, target: Target) -> bool:
    off_m = float(np.linalg.norm(np.array(pose.t) - target.t))
    return off_m > PLACE_TOLERANCE * target.range_m


def _errors(pose: Pose | None, target: Target) -> dict[str, float | None]:
    if pose is None:
        return dict.fromkeys(("range_error", "bearing_error_deg", "attitude_error_deg"))
    t = np.array(pose.t)
    turn = matrix_from_quaternion(pose.q_wxyz) @ target.R.T
    cosine = float(t @ target.t) / (float(np.linalg.norm(t)) * target.range_m)
    return {
        "range_error": float(np.linalg.norm(t)) / target.range_m - 1,
        "bearing_error_deg": _degrees(cosine),
        "attitude_error_deg": _degrees((float(np.trace(turn)) - 1) / 2),
    }


def _degrees(cosine: float) -> float:
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def hue_difference_deg(a_deg: float, b_deg: float) -> float:
    """Angle between two hues, 0..180."""
    apart = abs(a_deg - b_deg) % 360
    return min(apart, 360 - apart)
