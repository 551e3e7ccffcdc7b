"""Cameras as files: those that are shipped and the user's own."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from chromadock.camera import CameraModel
from chromadock.lens import PINHOLE_COUNTS
from chromadock.sim.control import AutoControl, ControlSpec
from chromadock.sim.response import Response
from chromadock.sim.sensor import Sensor
from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.toml_file import one_line_error, read_toml
from chromadock.validation import allowed, between

SHIPPED = ("vehicle", "ov2640")
"""Files in ``cameras/``, to take by name or to copy."""


@dataclass(frozen=True, eq=False)
class CameraSpec:
    """A camera: lens, sensor, control.

    Parameters
    ----------
    name
        What it is called: the file's name without its ending.
    model
        Pixels and rays; pixel (0, 0) is red.
    sensor
        Light and pictures.
    control
        How exposure and white balance are chosen.
    readout_s
        From reading the first row to the last; 0 is a global shutter.  Rows are read from
        the top at equal intervals.
    """

    name: str
    model: CameraModel
    sensor: Sensor
    control: ControlSpec
    readout_s: float

    def auto_control(self) -> AutoControl:
        """A new control of this camera, which has not seen anything yet."""
        return AutoControl(self.sensor, self.control)


def load_camera(name_or_path: str | Path) -> CameraSpec:
    """The shipped camera of that name, or the one in a TOML file laid out like it.

    Raises
    ------
    ChromadockError
        One line with the file, the key, what is wrong and what is allowed.
    """
    if str(name_or_path) in SHIPPED:
        file = resources.files("chromadock.sim") / "cameras" / f"{name_or_path}.toml"
        with resources.as_file(file) as path:
            return _loaded(path)
    return _loaded(Path(name_or_path))


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


def _even(pixels: float) -> float:
    if pixels % 2:
        raise ValueError("odd")
    return pixels


_Pixels = Annotated[
    int, Field(ge=16, le=4096), AfterValidator(_even), allowed("an even number, 16 to 4096 px")
]


def _as_opencv(distortion: list[float]) -> list[float]:
    if len(distortion) not in PINHOLE_COUNTS:
        raise ValueError("count")
    return distortion


class _Lens(_Section):
    width: _Pixels
    height: _Pixels
    focal_px: Annotated[float, between(10, 1e5, "px")]
    centre_px: Annotated[
        list[Annotated[float, Field(ge=0, le=4096)]],
        Field(min_length=2, max_length=2),
        allowed("[x, y], each 0 to 4096 px"),
    ]
    distortion: Annotated[
        list[Annotated[float, Field(ge=-100, le=100)]],
        AfterValidator(_as_opencv),
        allowed("4, 5, 8, 12 or 14 numbers, each -100 to 100, or none"),
    ] = []
    f_number: Annotated[float, between(0.5, 64)]

    def model(self, name: str) -> CameraModel:
        x, y = self.centre_px
        matrix = np.array([[self.focal_px, 0, x], [0, self.focal_px, y], [0, 0, 1]])
        return CameraModel(self.width, self.height, matrix, np.array(self.distortion), name)


class _Chip(_Section):
    base_iso: Annotated[float, between(1, 1e5)]
    full_well_e: Annotated[float, between(100, 1e7, "electrons")]
    read_noise_e: Annotated[float, between(0, 1000, "electrons")]
    bits: Annotated[int, between(8, 16, "bits")]
    readout_s: Annotated[float, between(0, 1, "s")]


class _Picture(_Section):
    gamma: Annotated[float, between(1.1, 4)]
    colour_correction: Annotated[float, between(0, 1)]
    jpeg_quality: Annotated[int | None, Field(ge=1, le=100), allowed("1 to 100, or left out")] = (
        None
    )


_Band = Annotated[
    tuple[
        Annotated[float, between(WAVELENGTHS_NM[0], WAVELENGTHS_NM[-1], "nm")],
        Annotated[float, between(5, 500, "nm")],
        Annotated[float, between(0.001, 10)],
    ],
    Field(strict=False),
]
_Bands = Annotated[list[_Band], Field(min_length=1)]


class _Curves(_Section):
    red: _Bands
    green: _Bands
    blue: _Bands


class _CameraFile(_Section):
    lens: _Lens
    sensor: _Chip
    response: _Curves
    picture: _Picture
    control: ControlSpec = ControlSpec()


def _loaded(path: Path) -> CameraSpec:
    mend = f"give the TOML file of a camera, or one of {', '.join(SHIPPED)}"
    try:
        file = _CameraFile.model_validate(read_toml(path, mend))
    except ValidationError as error:
        raise one_line_error(path, error) from None
    response = Response.of_bands(file.response.red, file.response.green, file.response.blue)
    sensor = Sensor(
        width=file.lens.width,
        height=file.lens.height,
        response=response,
        f_number=file.lens.f_number,
        base_iso=file.sensor.base_iso,
        full_well_e=file.sensor.full_well_e,
        read_noise_e=file.sensor.read_noise_e,
        bits=file.sensor.bits,
        gamma=file.picture.gamma,
        colour_matrix=response.colour_correction(file.picture.colour_correction),
        jpeg_quality=file.picture.jpeg_quality,
    )
    return CameraSpec(
        path.stem, file.lens.model(str(path)), sensor, file.control, file.sensor.readout_s
    )
