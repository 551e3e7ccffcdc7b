"""How the camera sits in the vehicle, and how the dock hangs: the extrinsics of the track."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError
from chromadock.rotation import checked_rotation

Floats = NDArray[np.float64]

R_BODY_CAMERA_FORWARD = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Camera axes in the body's for a camera that looks ahead: its x is the body's y (right), its y
the body's z (down), its z the body's x (forward)."""

R_LEVEL = np.eye(3)
"""Of a dock that hangs level and faces the approach."""


@dataclass(frozen=True, eq=False, slots=True)
class Mounting:
    """Rotations that do not change while the vehicle swims.

    Parameters
    ----------
    R_body_camera
        (3, 3) float64: columns are the camera's x, y, z (OpenCV: right, down, forward) in the
        vehicle's body (FRD: forward, right, down).  A camera that looks ahead, upright, unless
        given.
    R_level_dock
        (3, 3) float64: columns are the dock's x, y, z in the axes of a dock that hangs level and
        faces the approach.  The identity unless given.

    Both are made exactly orthonormal and read-only.

    Raises
    ------
    ChromadockError
        For a matrix that is not a rotation: see ``rotation.checked_rotation``.
    """

    R_body_camera: Floats = field(default_factory=R_BODY_CAMERA_FORWARD.copy)
    R_level_dock: Floats = field(default_factory=R_LEVEL.copy)

    def __post_init__(self) -> None:
        for name in ("R_body_camera", "R_level_dock"):
            given = getattr(self, name)
            object.__setattr__(self, name, checked_rotation(given, f"mounting: {name}"))


def mounting_or_default(mounting: Mounting | None) -> Mounting:
    """What the user gave; the default for None.

    Raises
    ------
    ChromadockError
        For anything else, such as a bare matrix.
    """
    if mounting is None:
        return Mounting()
    if not isinstance(mounting, Mounting):
        raise ChromadockError(
            f"mounting is a {type(mounting).__name__}: give Mounting(R_body_camera, R_level_dock)"
        )
    return mounting
