"""What a method of finding the dock is given, and what it gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.colour.background import BackgroundColour
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.geometry.pose import Estimate
from chromadock.marker_colour import ColourKind
from chromadock.results.detection import RGB, Blob, Misfit, Point
from chromadock.results.pose import Pose
from chromadock.stopwatch import Stopwatch


@dataclass(frozen=True, eq=False, slots=True)
class Look:
    """One frame, and what is known before it is searched.

    ``frame_bgr`` (H, W, 3) uint8 BGR; ``background``: the water's colour in it; ``hue``
    0..1535: of the markers as they should shine now.  ``colour``: whether they have that hue;
    where it is ``white`` or ``any`` no hue is to be preferred, and ``hue`` is only what an
    adaptive dock would show here.  ``priors``: where a track expects the
    dock in this frame, each with its information; ``everywhere``: also search where no prior
    has it; ``incomplete``: where no whole dock is found there, one with a marker out will do.
    ``R_expected`` (3, 3): how the camera should see the dock turned, ``R_camera_dock``, by the
    camera's mounting and the vehicle's attitude; None where the user told neither, and the
    camera is taken for upright.  ``R_covariance`` (3, 3), radians squared: of small turns from
    there about the camera's axes.
    """

    frame_bgr: NDArray[np.uint8]
    background: BackgroundColour
    hue: int
    camera: CameraModel
    priors: tuple[Estimate, ...] = ()
    everywhere: bool = True
    incomplete: bool = False
    R_expected: NDArray[np.float64] | None = None
    R_covariance: NDArray[np.float64] | None = None
    colour: ColourKind = "hue"

    @property
    def marker_rgb(self) -> RGB | None:
        """The pure colour of the markers, 0..255 a channel; None where it may be any."""
        if self.colour == "any":
            return None
        return (255, 255, 255) if self.colour == "white" else rgb_from_hsv(self.hue, 255, 255)


@dataclass(frozen=True, eq=False, slots=True)
class Found:
    """What a method made of one frame; markers and pose are None if no dock was found.

    ``state`` is ``found``, ``uncertain`` (markers, but the dock's place may be off by more than 5 %
    of the range: no pose), ``partial`` (all markers but one, about where a prior has them or
    where ``incomplete`` allows it) or ``not_found``; ``passed_fraction`` the share of the frame
    that stands out in the markers' colour; ``pose`` the better one, with its alternative.
    ``sigma_px``: standard deviations of the markers' places, in their order; ``smaller``: by
    which share of its size all of them together may make the dock look smaller than it is, one
    standard error; ``estimates``: both poses, with their information; all for a track.
    ``evidence``: decades by which the dock explains what was seen better than clutter does; None
    where a method does not weigh it.  ``hue`` 0..1535: of the light that the markers add, as
    received, None where they were found by their dark holders; ``clipped``, ``stops_over`` and
    ``misfit``: see ``Detection``.
    """

    state: str
    passed_fraction: float
    blobs: tuple[Blob, ...] = ()
    markers: dict[str, Point] | None = None
    pose: Pose | None = None
    estimates: tuple[Estimate, ...] = ()
    evidence: float | None = None
    hue: int | None = None
    clipped: float | None = None
    stops_over: float | None = None
    misfit: Misfit | None = None
    sigma_px: tuple[float, ...] = ()
    smaller: float = 0.0


class Method(Protocol):
    """A way to find the dock."""

    @property
    def mask(self) -> NDArray[np.uint8]:
        """(H, W): nonzero where the last frame stood out in the markers' colour."""

    def find(self, look: Look, watch: Stopwatch) -> Found:
        """Look for the dock in one frame."""
