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
from chromadock.marker_colour import ColourKind, MarkerColour
from chromadock.mounting import Mounting
from chromadock.paper.method import PaperMethod
from chromadock.robust.method import RobustMethod
from chromadock.stopwatch import Stopwatch
from chromadock.track.attitude import expected_if_told


class Finders:
    """The paper's blobs, constellation and pose after each of the masks, and the robust method.

    Parameters
    ----------
    dock, camera
        The dock looked for, and the camera that looks.
    tuned
        What the static filters pass.
    mounting
        How the camera sits in the vehicle, where the robust method is told; None: it is not.
    """

    def __init__(
        self,
        dock: DockGeometry,
        camera: CameraModel,
        tuned: Tuned,
        mounting: Mounting | None = None,
    ) -> None:
        self._camera = camera
        self._colour = None if dock.colour is None else MarkerColour.parse(dock.colour)
        self._expected = expected_if_told(None, mounting)
        self._tuned = tuned
        self._paper = PaperMethod(dock)
        self._robust = RobustMethod(dock)

    def find(self, name: str, view: View, mapping: str) -> tuple[Found, NDArray[np.uint8]]:
        """What ``name``, one of ``FILTERS``, makes of a frame by itself, and its mask (H, W).

        ``mapping`` is the run's own: the robust method looks for the hue that the dock shows, or
        for the colour that a dock has of its own, where an adaptive filter looks for the hue of
        its own mapping.
        """
        if name == ROBUST:
            look = self._look(view, mapping)
            return self._robust.find(look, Stopwatch()), self._robust.mask
        mask = filter_mask(name, view, self._tuned)
        return self._paper.find_in_mask(mask, self._camera, Stopwatch()), mask

    def _look(self, view: View, mapping: str) -> Look:
        """What ``Detector`` gives to the robust method."""
        hue = view.marker_hues[mapping]
        kind: ColourKind = "hue"
        if self._colour is not None:
            hue = hue if self._colour.hue is None else self._colour.hue
            kind = self._colour.kind
        R, covariance = self._expected
        return Look(
            view.frame_bgr,
            view.background,
            hue,
            self._camera,
            R_expected=R,
            R_covariance=covariance,
            colour=kind,
        )
