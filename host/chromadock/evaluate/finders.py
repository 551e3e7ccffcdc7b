"""The ways to find the dock that are compared, each given the same frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.evaluate.filters import ROBUST, filter_mask
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.view import View
from chromadock.look import Found, Look
from chromadock.paper.method import PaperMethod
from chromadock.robust.method import RobustMethod
from chromadock.stopwatch import Stopwatch


class Finders:
    """The paper's blobs, constellation and pose after each of the masks, and the robust method.

    Parameters
    ----------
    dock, camera
        The dock looked for, and the camera that looks.
    tuned
        What the static filters pass.
    """

    def __init__(self, dock: DockGeometry, camera: CameraModel, tuned: Tuned) -> None:
        self._camera = camera
        self._tuned = tuned
        self._paper = PaperMethod(dock)
        self._robust = RobustMethod(dock)

    def find(self, name: str, view: View, mapping: str) -> tuple[Found, NDArray[np.uint8]]:
        """What ``name``, one of ``FILTERS``, makes of a frame by itself, and its mask (H, W).

        ``mapping`` is the run's own: the robust method looks for the hue that the dock shows,
        where an adaptive filter looks for that of its own mapping.
        """
        if name == ROBUST:
            hue = view.marker_hues[mapping]
            look = Look(view.frame_bgr, view.background, hue, self._camera)
            return self._robust.find(look, Stopwatch()), self._robust.mask
        mask = filter_mask(name, view, self._tuned)
        return self._paper.find_in_mask(mask, self._camera, Stopwatch()), mask
