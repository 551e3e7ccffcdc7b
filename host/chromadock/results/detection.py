"""What the detector says of one frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from chromadock.results import record
from chromadock.results.pose import Pose
from chromadock.results.track import Track

RGB = tuple[int, int, int]
Point = tuple[float, float]

MOST_CLIPPED = 0.6
"""Share of overexposed lamps that deserves a word: ranges suffer."""


@dataclass(frozen=True, slots=True)
class Background:
    """The water's colour: ``rgb`` 0..255, ``hue_deg`` 0..360 (None where the hue
    means nothing: grey water, night), ``confidence`` 0..1."""

    rgb: RGB
    hue_deg: float | None
    confidence: float


@dataclass(frozen=True, slots=True)
class Marker:
    """The colour that is looked for: a pure colour, which the dock's LEDs should show now.

    ``rgb`` 0..255 and ``hue_deg`` 0..360 are None where there is none to prefer; white has
    no hue.  ``given``: ``#RRGGBB``, ``white`` or ``any`` where the colour was given beforehand;
    None where it is worked out from the water's.  ``received_deg``: the hue of the light that
    markers were found to add, None without, where all of it clips, or where the dock was found by
    its dark holders alone; it differs by some tens of degrees where both sides agree, and by more
    where they do not.
    """

    rgb: RGB | None
    hue_deg: float | None
    received_deg: float | None = None
    given: str | None = None


@dataclass(frozen=True, slots=True)
class Blob:
    """A round spot in the image: centre ``x, y`` and ``radius``, in pixels.

    ``accepted`` is False where the spatial filter threw it out.
    """

    x: float
    y: float
    radius: float
    accepted: bool


@dataclass(frozen=True, slots=True)
class Misfit:
    """Something that stands like the dock, but not as its file and the calibration have it; it may
    be found all the same.

    ``evidence``: decades by which the places, strengths and colours speak for a dock;
    ``error_px``: root mean square distance of its markers from those of the rigid dock.
    """

    evidence: float
    error_px: float


@dataclass(frozen=True, slots=True)
class Detection:
    """Everything one frame told.  Fields that do not apply are None.

    ``state`` and ``evidence``: see ``look.Found``; ``passed_fraction`` the
    share of pixels that stand out in the markers' colour, 0..1; ``observed`` the RGB, 0..255,
    that the camera should see of a marker, None where that may be any; ``markers`` maps the
    dock's marker names to their pixel; ``track`` what all frames so far tell, at this one's time
    (None where frames are treated alone); ``clipped`` the share of the markers, 0..1, whose core
    is overexposed, and ``stops_over`` by how many stops the exposure should be shorter for the
    median of those (see ``overexposure.stops_over``), both None where the dock was found by its
    dark holders and not by its lamps; ``timing_ms`` milliseconds by stage, with
    ``total``.
    """

    state: str
    background: Background
    marker: Marker
    observed: RGB | None
    passed_fraction: float
    blobs: tuple[Blob, ...] = ()
    markers: dict[str, Point] | None = None
    pose: Pose | None = None
    evidence: float | None = None
    track: Track | None = None
    clipped: float | None = None
    stops_over: float | None = None
    misfit: Misfit | None = None
    timing_ms: dict[str, float] = field(default_factory=dict)

    @property
    def found(self) -> bool:
        """True only when a full, consistent constellation was accepted."""
        return self.state == "found"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of ``chromadock detect --json``, without file and frame."""
        return record.of_detection(self)

    @staticmethod
    def from_dict(content: Mapping[str, Any]) -> Detection:
        """What ``to_dict`` told, to the digits that it gives; further keys are passed over.

        Raises
        ------
        ChromadockError
            One line, where it is of another schema, or a key is missing or no such value.
        """
        return record.to_detection(content)
