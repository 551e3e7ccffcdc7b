"""A scene: everything that was drawn for it, and what is true of its picture."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.variety.cameras import camera_model
from chromadock.variety.docks import dock_geometry
from chromadock.variety.factors import variety

Floats = NDArray[np.float64]
Image = NDArray[np.float32]
Triple = tuple[float, float, float]

NO_DOCK = "none"


@dataclass(frozen=True, slots=True)
class Thing:
    """What stands or shines about the dock.

    Parameters
    ----------
    kind
        Its form; a lamp is round and shines.
    place
        x, y, z, metres, in the dock's frame (where there is no dock: of one that is not shown).
    size_m
        Radius of a disc or a lamp, half the height of a box, half the width of a post.
    aspect
        Width of a box over its height.
    colour
        Linear RGB: reflectance, or the light of a lamp, of which the strongest channel is 1.
    own_colour
        Whether it has the markers' colour instead.
    radiance
        Of a lamp, in full scales.
    """

    kind: Literal["disc", "box", "post", "lamp"]
    place: Triple
    size_m: float
    colour: Triple
    aspect: float = 1.0
    own_colour: bool = False
    radiance: float = 0.0


@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """All that was drawn for one picture; names of choices are those of ``variety.toml``.

    Attributes that need words: ``distance`` and ``distance_m`` are those of a dock as wide as the
    original that looks as large, ``range_m`` the true z of the dock in the camera's frame;
    ``lamp_gains`` (N) and ``holders_m`` (N), diameters, are of each lamp; ``attenuation`` is the
    beam's, 1/m, of red, green and blue; lengths of lamps and bars are true metres; pixels of
    shake and defocus are those of a frame 640 wide; ``R`` (3, 3) and ``t`` (3,) metres are
    ``T_camera_dock``; ``photograph`` is None for rendered water.
    """

    seed: int
    index: int
    dock: str
    width_m: float
    build: str
    colour: str
    mapping: str
    lamp_profile: str
    lamp_radius_m: float
    radiance: float
    crosstalk: float
    unlikeness: float
    lamp_gains: tuple[float, ...]
    holders_m: tuple[float, ...]
    bar_width_m: float
    bar_reflectance: float
    camera: str
    principal_point: str
    offset: tuple[float, float]
    mounting: str
    distance: str
    distance_m: float
    range_m: float
    yaw_deg: float
    pitch_deg: float
    roll_deg: float
    R: Floats
    t: Floats
    mean_attenuation: float
    attenuation: Triple
    halo_rad: float
    scattered_share: float
    backdrop: str
    photograph: Path | None
    waters: str
    surface: str
    mirrored: bool
    zoom: float
    daylight: str
    daylight_level: float
    exposure: str
    exposure_gain: float
    target: float
    white_balance: str
    balance: float
    shake_px: float
    shake_deg: float
    field_shift_px: float
    defocus_px: float
    vignette: float
    shot_noise: float
    code_noise: float
    gamma: float
    s_curve: float
    jpeg_quality: int
    subsampling: str
    clutter: str
    things: tuple[Thing, ...]

    @property
    def camera_model(self) -> CameraModel:
        """The calibration, which is exact."""
        return camera_model(self.camera, self.offset)

    @property
    def dock_geometry(self) -> DockGeometry | None:
        """The markers; None where there is no dock."""
        return None if self.dock == NO_DOCK else dock_geometry(self.dock, self.width_m)

    @property
    def bars(self) -> tuple[tuple[int, int], ...]:
        """Pairs of markers that a bar joins."""
        barred = self.dock != NO_DOCK and "bars" in self.build
        return variety().docks[self.dock].bars if barred else ()

    def factors(self) -> dict[str, str | float | int]:
        """Every drawn name and number but those of single lamps and things, to tabulate by."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        plain = {k: v for k, v in values.items() if isinstance(v, str | float | int)}
        return plain | {"photograph": self.photograph.name if self.photograph else self.waters}


@dataclass(frozen=True, eq=False, slots=True)
class Truth:
    """What is true of a rendered picture.

    Parameters
    ----------
    camera, dock
        As calibrated and as built; no dock is None.
    R, t
        ``T_camera_dock``: (3, 3), (3,) metres; of no dock NaN.
    pixels
        (N, 2) float64: the lamps' centres, pixels.
    in_view
        (N,) bool: which are within the frame.
    lamp_rgb
        Pure colour that the LEDs show, 0..255.
    """

    camera: CameraModel
    dock: DockGeometry | None
    R: Floats
    t: Floats
    pixels: Floats
    in_view: NDArray[np.bool_]
    lamp_rgb: tuple[int, int, int]
