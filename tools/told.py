"""The poses that a detection tells, to be held against the truth."""

from __future__ import annotations

import numpy as np

from chromadock import Detection
from chromadock.geometry.pose import Estimate
from chromadock.rotation import matrix_from_quaternion


def told_poses(detection: Detection) -> tuple[Estimate, ...]:
    """The pose and its alternative, the better first; none where no covariance is told."""
    pose = detection.pose
    poses = [] if pose is None else [p for p in (pose, pose.alternative) if p is not None]
    return tuple(
        Estimate(
            matrix_from_quaternion(p.q_wxyz),
            np.array(p.t),
            0.0,
            p.reprojection_px,
            np.linalg.pinv(np.reshape(p.covariance, (6, 6)), rcond=1e-14, hermitian=True),
        )
        for p in poses
        if p.covariance is not None
    )
