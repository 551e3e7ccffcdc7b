"""Markers where a pose known beforehand expects them, of which one may be missing."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.geometry.pose import Estimate, projected
from chromadock.robust.evidence import evidence_of_sets, placed_along
from chromadock.robust.peaks import Peaks

MIN_MARKERS = 3
"""Fewer give no pose."""

HIDDEN = 0.1
"""How often a marker is out or behind something."""

# Chi-square with two degrees of freedom that true markers exceed in 0.1%.
_GATE = 13.8
# Ways to choose the peaks: bounds the time.
_MAX_CHOICES = 64


@dataclass(frozen=True, slots=True)
class Guess:
    """``markers`` (k,) of the dock at ``members`` (k,) of the peaks, and the evidence.

    ``expected`` (k, 2): pixels, where they were expected, if they were.
    """

    markers: NDArray[np.intp]
    members: NDArray[np.intp]
    evidence: float
    expected: NDArray[np.float64] | None = None


def guided(
    points_dock: NDArray[np.float64],
    prior: Estimate,
    peaks: Peaks,
    sigma_px: float,
    camera: CameraModel,
) -> Guess | None:
    """The best set of all markers, or of all but one, about where ``prior`` has them.

    The evidence is the same likelihood ratio as the search's, with what the prior says of
    the pose in place of all views.

    Parameters
    ----------
    points_dock : (n, 3) metres.
    prior : the pose expected of this frame, with its information.
    sigma_px : standard deviation of the peaks' places.
    """
    seen = projected(points_dock, prior.R, prior.t, camera)
    if seen is None or len(peaks.snr) < MIN_MARKERS:
        return None
    expected, derivatives = seen
    count, along = len(points_dock), placed_along(points_dock)
    jacobian = derivatives.reshape(-1, 6)
    covariance = jacobian @ prior.covariance @ jacobian.T + sigma_px**2 * np.eye(2 * count)
    z, area = peaks.xy @ np.array([1, 1j]), float(camera.width * camera.height)

    most = max(1, int(_MAX_CHOICES ** (1 / count)))
    options: list[list[int]] = []
    size = np.array([camera.width, camera.height])
    for marker in range(count):
        # What shines at the border is not a marker that is beyond it, but what is left of its halo.
        if not ((expected[marker] > 0) & (expected[marker] < size - 1)).all():
            options.append([])
            continue
        off = peaks.xy - expected[marker]
        own = covariance[2 * marker : 2 * marker + 2, 2 * marker : 2 * marker + 2]
        square = (off @ np.linalg.inv(own) * off).sum(axis=1)
        near = np.argsort(square)[:most]
        options.append([int(i) for i in near if square[i] < _GATE])

    best: Guess | None = None
    for left_out in (None, *range(count)):
        markers = np.array([m for m in range(count) if m != left_out])
        if len(markers) < MIN_MARKERS:
            continue
        rows = (2 * markers[:, None] + [0, 1]).ravel()
        part = covariance[np.ix_(rows, rows)]
        inverse, log_norm = np.linalg.inv(part), -0.5 * np.linalg.slogdet(2 * np.pi * part)[1]
        chance = np.log(1 - HIDDEN if left_out is None else HIDDEN)
        choices = [c for c in product(*(options[m] for m in markers)) if len(set(c)) == len(c)]
        if not choices:
            continue
        members = np.array(choices)
        off = (peaks.xy[members] - expected[markers]).reshape(len(members), -1)
        evidence = chance + log_norm - 0.5 * (off @ inverse * off).sum(axis=1)
        evidence += evidence_of_sets(z, peaks, area, members, along[markers])
        k = int(evidence.argmax())
        if best is None or evidence[k] > best.evidence:
            best = Guess(markers, members[k], float(evidence[k]), expected[markers])
    return best
