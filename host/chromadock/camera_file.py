"""Reads the ``camera_info`` YAML of ROS, and OpenCV's own dialect of it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import yaml
from numpy.typing import NDArray
from pydantic import BaseModel, Field, ValidationError

from chromadock.errors import ChromadockError
from chromadock.text import one_line
from chromadock.validation import place, shown, wording

_Number = Annotated[float, Field(allow_inf_nan=False)]
_Pixels = Annotated[int, Field(gt=0)]

MODELS: dict[str, tuple[int, ...]] = {
    "plumb_bob": (0, 4, 5),
    "rational_polynomial": (0, 8, 12, 14),
}
"""The lens models of ROS that OpenCV's formula covers, and their numbers of coefficients."""


class _Matrix(BaseModel):
    data: Annotated[list[_Number], Field(min_length=9, max_length=9)]


class _Coefficients(BaseModel):
    data: list[_Number]


class _CameraInfo(BaseModel):
    """Only the keys that are used; calibration tools write many more."""

    image_width: _Pixels
    image_height: _Pixels
    camera_matrix: _Matrix
    distortion_coefficients: _Coefficients
    distortion_model: str | None = None


class _Loader(yaml.SafeLoader):
    """SafeLoader that also knows OpenCV's matrix tag."""


def _opencv_matrix(loader: _Loader, node: yaml.MappingNode) -> dict[Any, Any]:
    return loader.construct_mapping(node, deep=True)


_Loader.add_constructor("tag:yaml.org,2002:opencv-matrix", _opencv_matrix)


def read_camera_file(
    path: Path,
) -> tuple[int, int, NDArray[np.float64], NDArray[np.float64]]:
    """Width, height (pixels), 3x3 camera matrix and (n,) distortion of a camera YAML.

    Raises
    ------
    ChromadockError
        One line with the file, the key, what is wrong and the mend.
    """
    try:
        info = _CameraInfo.model_validate(_load(path))
    except ValidationError as error:
        raise ChromadockError(f"{path}: {_explain(error)}") from None
    _check_model(path, info)
    matrix = np.array(info.camera_matrix.data, dtype=np.float64).reshape(3, 3)
    distortion = np.array(info.distortion_coefficients.data, dtype=np.float64)
    return info.image_width, info.image_height, matrix, distortion


def _load(path: Path) -> dict[str, Any]:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ChromadockError(
            f"{path}: cannot read the camera file ({error.strerror}): "
            "give the camera_info YAML of your calibration"
        ) from None
    except UnicodeDecodeError:
        raise ChromadockError(
            f"{path}: not a text file: give the camera_info YAML of your calibration"
        ) from None
    # OpenCV writes "%YAML:1.0", which no other YAML reader accepts.
    text = re.sub(r"\A%YAML:1\.0[^\n]*\n", "", text)
    try:
        content = yaml.load(text, Loader=_Loader)
    except yaml.YAMLError as error:
        raise ChromadockError(
            f"{path}: not valid YAML ({_problem(error)}): export the calibration again"
        ) from None
    if not isinstance(content, dict):
        raise ChromadockError(
            f"{path}: no keys in it: give the camera_info YAML of your calibration"
        )
    return content


def _problem(error: yaml.YAMLError) -> str:
    """PyYAML's words without its picture of the place, and with the line."""
    mark = getattr(error, "problem_mark", None)
    words = one_line(getattr(error, "problem", None) or error, 80)
    return words if mark is None else f"line {mark.line + 1}: {words}"


def _explain(error: ValidationError) -> str:
    """The first fault of a camera file in one line."""
    fault: Any = error.errors()[0]
    where, given, kind = place(fault["loc"]), fault["input"], fault["type"]
    if kind == "missing":
        return f"{where} is missing: give the camera_info YAML of your calibration"
    if kind in ("too_short", "too_long"):
        return f"{where} has {len(given)} numbers: it must have 9 (3 rows of 3)"
    if kind == "greater_than":
        return f"{where} is {given}: it must be positive, in pixels"
    if kind == "finite_number":
        return f"{where} is {given}: it must be a finite number, so calibrate again"
    wanted = "rows, cols and data" if kind == "model_type" else wording(fault)
    return f"{where} is {shown(given)}: it must be {wanted}"


def _check_model(path: Path, info: _CameraInfo) -> None:
    """Refuse a lens model that is not OpenCV's formula, and a count that belies the model."""
    model = info.distortion_model
    count = len(info.distortion_coefficients.data)
    if not model:  # OpenCV's own files name none; the count tells the formula
        return
    if model not in MODELS:
        raise ChromadockError(
            f"{path}: distortion_model {model} is not supported: "
            f"calibrate with {' or '.join(MODELS)}"
        )
    if count not in MODELS[model]:
        allowed = " or ".join(str(n) for n in MODELS[model] if n)
        raise ChromadockError(
            f"{path}: distortion_coefficients has {count} numbers, "
            f"but {model} has {allowed}: correct the list or the distortion_model"
        )
