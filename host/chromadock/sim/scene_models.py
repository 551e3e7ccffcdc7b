"""What may stand in a scene's TOML file: keys, units, ranges.  See ``scenes/pool.toml``."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.validation import allowed, between


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class _OfKind(_Section):
    """A table in which one key says which others belong there."""

    chooser: ClassVar[str]
    common: ClassVar[frozenset[str]] = frozenset()
    needed: ClassVar[dict[str, tuple[str, ...]]]
    optional: ClassVar[dict[str, tuple[str, ...]]] = {}

    @model_validator(mode="after")
    def _check_keys(self) -> _OfKind:
        kind = getattr(self, self.chooser)
        stated = f'{self.chooser} = "{kind}"'
        needed, optional = self.needed[kind], self.optional.get(kind, ())
        given = self.model_fields_set - {self.chooser} - self.common
        for key in sorted(given - {*needed, *optional}):
            known = ", ".join((*needed, *optional))
            raise ValueError(f"{key} does not go with {stated}, which takes {known}")
        for key in needed:
            if key not in given:
                raise ValueError(f"{key} is missing, which goes with {stated}")
        return self


_Vector = Annotated[
    list[Annotated[float, Field(ge=-100, le=100)]],
    Field(min_length=3, max_length=3),
    allowed("[x, y, z], each -100 to 100 m"),
]
_Size = Annotated[
    list[Annotated[float, Field(gt=0, le=100)]],
    Field(min_length=3, max_length=3),
    allowed("[x, y, z], each more than 0, at most 100 m"),
]
_Colour = Annotated[
    list[Annotated[float, Field(ge=0, le=1)]],
    Field(min_length=3, max_length=3),
    allowed("[r, g, b], linear, each 0 to 1"),
]
_Velocity = Annotated[
    list[Annotated[float, Field(ge=-5, le=5)]],
    Field(min_length=3, max_length=3),
    allowed("[north, east, down], each -5 to 5 m/s"),
]
_Coefficients = Annotated[
    list[Annotated[float, Field(gt=0, le=1000)]],
    Field(min_length=2),
    allowed("two or more numbers, each more than 0, at most 1000"),
]
_Span = Annotated[
    list[Annotated[float, Field(ge=-1e6, le=1e6)]],
    Field(min_length=2, max_length=2),
    allowed("[start, end], each -1000000 to 1000000 s"),
]
_Radius = Annotated[float, between(0.0005, 50, "m")]
_Offset = Annotated[float, between(-20, 20, "m")]
_Angle = Annotated[float, between(-90, 90, "degrees")]
_Roll = Annotated[float, between(-180, 180, "degrees")]
_Heading = Annotated[float, between(-360, 360, "degrees from north by east")]
_Seconds = Annotated[float, between(0.01, 1e6, "s")]
_Moment = Annotated[float, between(-1e6, 1e6, "s")]
_Depth = Annotated[float, between(0.05, 200, "m")]
_ORIGIN = [0.0, 0.0, 0.0]


class _Substance(_OfKind):
    scattering_per_m: Annotated[float, between(0.001, 20, "1/m")] = 0.2
    visibility_m: Annotated[float, between(0.05, 100, "m")] = 1.0
    cdom_per_m: Annotated[float, between(0, 50, "1/m at 440 nm")] = 0.0
    type: str = ""
    wavelengths_nm: _Coefficients = []
    a_per_m: _Coefficients = []
    b_per_m: _Coefficients = []

    chooser: ClassVar[str] = "kind"
    needed: ClassVar[dict[str, tuple[str, ...]]] = {
        "pool": (),
        "lake": ("visibility_m",),
        "jerlov": ("type",),
        "measured": ("wavelengths_nm", "a_per_m", "b_per_m"),
        "mixed": ("part",),
    }
    optional: ClassVar[dict[str, tuple[str, ...]]] = {
        "pool": ("scattering_per_m",),
        "lake": ("cdom_per_m",),
    }


class WaterPart(_Substance):
    """``[[water.part]]`` of a mixed water."""

    kind: Annotated[
        Literal["pool", "lake", "jerlov", "measured"],
        allowed('"pool", "lake", "jerlov" or "measured"'),
    ]
    share: Annotated[float, between(0, 1)]

    common: ClassVar[frozenset[str]] = frozenset({"share"})


class WaterSection(_Substance):
    """``[water]``."""

    kind: Annotated[
        Literal["pool", "lake", "jerlov", "measured", "mixed"],
        allowed('"pool", "lake", "jerlov", "measured" or "mixed"'),
    ]
    part: Annotated[list[WaterPart], Field(min_length=1)] = []


class CloudSection(_Section):
    """``[[light.cloud]]``."""

    start_s: _Moment
    fade_s: _Seconds
    transmittance: Annotated[float, between(0.01, 1)]
    end_s: _Moment | None = None


class LightSection(_Section):
    """``[light]``."""

    surface_illuminance_lux: Annotated[float, between(0, 200_000, "lux")]
    sun_elevation_deg: Annotated[float, between(-90, 90, "degrees")]
    sun_azimuth_deg: _Heading
    diffuse_share: Annotated[float, between(0, 1)]
    flicker: bool = True
    cloud: list[CloudSection] = []


class PlaceSection(_Section):
    """``[place]``."""

    depth_m: _Depth
    floor_depth_m: _Depth | None = None
    floor_rgb: _Colour = [0.3, 0.3, 0.3]
    wall_distance_m: Annotated[float, between(0.1, 1000, "m")] | None = None
    wall_rgb: _Colour = [0.3, 0.3, 0.3]
    wind_m_s: Annotated[float, between(0, 30, "m/s")]


class SwaySection(_Section):
    """``[dock.sway]`` and ``[vehicle.sway]``."""

    surge_m: Annotated[float, between(0, 5, "m")] = 0.0
    sway_m: Annotated[float, between(0, 5, "m")] = 0.0
    heave_m: Annotated[float, between(0, 5, "m")] = 0.0
    roll_deg: _Angle = 0.0
    pitch_deg: _Angle = 0.0
    yaw_deg: _Angle = 0.0
    period_s: Annotated[float, between(0.2, 60, "s")] = 4.0


class EmitterSection(_Section):
    """``dock.lamp.red`` and its like."""

    peak_nm: Annotated[float, between(WAVELENGTHS_NM[0], WAVELENGTHS_NM[-1], "nm")]
    fwhm_nm: Annotated[float, between(5, 200, "nm")]
    intensity_cd: Annotated[float, between(0, 10_000, "cd")]


class LampSection(_Section):
    """``[dock.lamp]``."""

    red: EmitterSection
    green: EmitterSection
    blue: EmitterSection
    power: Annotated[float, between(0, 100, "times")] = 1.0
    diameter_m: Annotated[float, between(0.001, 1, "m")]
    half_angle_deg: Annotated[float, between(5, 85, "degrees")]


class FailureSection(_Section):
    """An element of ``dock.failure``."""

    marker: str
    at_s: _Moment


class DockSection(_Section):
    """``[dock]``."""

    geometry: str = ""
    colour: str | None = None
    markers_out: list[str] = []
    failure: list[FailureSection] = []
    frame: bool = True
    frame_rgb: _Colour = [0.03, 0.03, 0.03]
    lamp: LampSection
    sway: SwaySection = SwaySection()


class BodySection(_OfKind):
    """``[[body]]``."""

    shape: Annotated[
        Literal["sphere", "tube", "box", "panel"], allowed('"sphere", "tube", "box" or "panel"')
    ]
    rgb: _Colour
    fixed_to: Annotated[Literal["dock", "world"], allowed('"dock" or "world"')] = "dock"
    centre_m: _Vector = _ORIGIN
    radius_m: _Radius = 1.0
    from_m: _Vector = _ORIGIN
    to_m: _Vector = _ORIGIN
    size_m: _Size = [1.0, 1.0, 1.0]
    half_across_m: _Vector = _ORIGIN
    half_down_m: _Vector = _ORIGIN
    present_s: _Span | None = None

    chooser: ClassVar[str] = "shape"
    common: ClassVar[frozenset[str]] = frozenset({"rgb", "fixed_to", "present_s"})
    needed: ClassVar[dict[str, tuple[str, ...]]] = {
        "sphere": ("centre_m", "radius_m"),
        "tube": ("from_m", "to_m", "radius_m"),
        "box": ("centre_m", "size_m"),
        "panel": ("centre_m", "half_across_m", "half_down_m"),
    }


class ApproachSection(_Section):
    """``[vehicle.approach]``."""

    to_m: Annotated[float, between(0.2, 100, "m")]
    duration_s: _Seconds


class VehicleSection(_Section):
    """``[vehicle]``."""

    heading_deg: _Heading
    distance_m: Annotated[float, between(0.2, 100, "m")]
    approach: ApproachSection | None = None
    offset_right_m: _Offset = 0.0
    offset_down_m: _Offset = 0.0
    aim_yaw_deg: _Angle = 0.0
    aim_pitch_deg: _Angle = 0.0
    aim_roll_deg: _Roll = 0.0
    camera_roll_deg: _Roll = 0.0
    sway: SwaySection = SwaySection()


class ParticlesSection(_Section):
    """``[particles]``."""

    concentration_per_m3: Annotated[float, between(0, 100_000, "1/m^3")]
    diameter_m: Annotated[float, between(1e-5, 0.01, "m")]
    drift_m_s: _Velocity = _ORIGIN


class CameraSection(BaseModel):
    """``[vehicle_camera]`` and ``[dock_camera]``: other keys are those of a camera's control."""

    model_config = ConfigDict(extra="allow", strict=True)

    model: str

    @property
    def control(self) -> dict[str, Any]:
        """What the scene changes of the camera's ``[control]``."""
        return dict(self.model_extra or {})


class SceneFile(_Section):
    """A whole scene."""

    seed: Annotated[int, Field(ge=0, le=2**31 - 1), allowed("0 to 2147483647")] = 0
    water: WaterSection
    light: LightSection
    place: PlaceSection
    dock: DockSection
    vehicle: VehicleSection
    particles: ParticlesSection | None = None
    vehicle_camera: CameraSection
    dock_camera: CameraSection
    body: list[BodySection] = []


def rgb(colour: list[float]) -> tuple[float, float, float]:
    """A colour's three numbers."""
    red, green, blue = colour
    return red, green, blue
