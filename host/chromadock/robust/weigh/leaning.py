"""How much less sure poses are by what may be wrong with all markers together.

It counts in a pose's covariance, and not in a single frame's doubt: few single frames are wrong by
it, and a track, which many such frames would make sure, has doubts of its own.
"""

from __future__ import annotations

import numpy as np

from chromadock.geometry.many import leaning_gradient, normal_equations
from chromadock.geometry.pose import Estimate, Sighting
from chromadock.robust.weigh.placement import PosePrior


def leaning(
    sighting: Sighting, poses: tuple[Estimate, ...], prior: PosePrior
) -> tuple[Estimate, ...]:
    """Poses that were fitted to a sighting, with that in their information."""
    if sighting.lean_px is None:
        return poses
    R, t = np.array([pose.R for pose in poses]), np.array([pose.t for pose in poses])
    information, gradient, _, _ = normal_equations(sighting, R, t)
    # Places hardly tell a far dock's tilt: what they would make of it is not believed.
    information[:, 3:, 3:] += prior.R_information
    more = leaning_gradient(sighting, R, t, gradient)
    off = np.linalg.solve(information, more[..., None])[..., 0]
    return tuple(pose.drawn(step) for pose, step in zip(poses, off, strict=True))
