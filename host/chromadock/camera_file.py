"""Reads the camera files of calibration tools: ROS, OpenCV, Kalibr, or a CameraInfo as printed."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from chromadock.camera_layouts import (
    KEEP,
    foreign_keys,
    foreign_text,
    kalibr_cameras,
    layout_of,
)
from chromadock.camera_window import Calibration, Roi, windowed
from chromadock.errors import ChromadockError
from chromadock.lens_words import lens_told
from chromadock.text import one_line
from chromadock.text_file import read_text
from chromadock.validation import place, shown, wording

_GZIP = b"\x1f\x8b"


class _Loader(yaml.SafeLoader):
    """SafeLoader that also knows OpenCV's matrix tag."""


def _opencv_matrix(loader: _Loader, node: yaml.MappingNode) -> dict[Any, Any]:
    return loader.construct_mapping(node, deep=True)


_Loader.add_constructor("tag:yaml.org,2002:opencv-matrix", _opencv_matrix)


def read_camera_file(path: Path) -> Calibration:
    """What a camera file has, of the pictures that the camera gives: region of interest and
    binning are applied.

    Raises
    ------
    ChromadockError
        One line with the file, the key, what is wrong and the mend.
    """
    return calibration_of(_camera_of(path, _load(path)), str(path))


def calibration_of(content: Mapping[str, Any], name: str) -> Calibration:
    """The same from the keys of a camera file or of a CameraInfo message, in lower case.

    ``name`` says in messages where they are from.

    Raises
    ------
    ChromadockError
        One line with the name, the key, what is wrong and the mend.
    """
    fault = foreign_keys(content)
    lens, unknown = lens_told(content)
    if fault or unknown:
        raise ChromadockError(f"{name}: {fault or unknown}")
    try:
        read = layout_of(content).model_validate(content)
    except ValidationError as error:
        raise ChromadockError(f"{name}: {_explain(error)}") from None
    full = read.full(lens)
    calibration = _aside(full) or windowed(full, read.roi or Roi(), read.binning)
    if isinstance(calibration, str):
        raise ChromadockError(f"{name}: {calibration}")
    return calibration


def _aside(full: Calibration) -> str | None:
    """Whether the lens looks past the sensor, in words; a region of it may well be aside."""
    x, y = full.matrix[:2, 2].tolist()
    if -0.5 <= x <= full.width - 0.5 and -0.5 <= y <= full.height - 0.5:
        return None
    return (
        f"camera_matrix has its principal point at ({x:g}, {y:g}), outside the picture of "
        f"{full.width}x{full.height} pixels: correct either, both in pixels of the same camera mode"
    )


def _load(path: Path) -> dict[str, Any]:
    """The file's keys, in lower case, and values."""
    try:
        text = read_text(path)
    except OSError as error:
        raise ChromadockError(
            f"{path}: cannot read the camera file ({error.strerror}): {KEEP}"
        ) from None
    except UnicodeDecodeError:
        packed = path.read_bytes()[:2] == _GZIP
        mend = "unpack it and give the .yaml in it" if packed else KEEP
        raise ChromadockError(f"{path}: not a text file: {mend}") from None
    foreign = foreign_text(text)
    if foreign:
        raise ChromadockError(f"{path}: {foreign}")
    # OpenCV writes "%YAML:1.0", which no other YAML reader accepts.
    text = re.sub(r"\A%YAML:1\.0[^\n]*\n", "", text)
    try:
        # Messages that are printed one after the other are so many documents.
        documents = [d for d in yaml.load_all(text, Loader=_Loader) if d is not None]
    except yaml.YAMLError as error:
        raise ChromadockError(
            f"{path}: not valid YAML ({_problem(error)}): export the calibration again"
        ) from None
    if not documents or not isinstance(documents[0], dict):
        raise ChromadockError(f"{path}: no keys in it: {KEEP}")
    return _lower(documents[0])


def _lower(content: dict[Any, Any]) -> dict[str, Any]:
    """ROS 1 prints K where ROS 2 prints k, and OpenCV has written Camera_Matrix."""
    return {str(key).lower(): value for key, value in content.items()}


def _camera_of(path: Path, content: dict[str, Any]) -> dict[str, Any]:
    """The one camera of Kalibr's camchain; the same content for any other layout."""
    cameras = kalibr_cameras(content)
    if not cameras:
        return content
    if len(cameras) > 1:
        raise ChromadockError(
            f"{path}: {' and '.join(cameras)} are in it: write the one that you use alone in a file"
        )
    return _lower(content[cameras[0]])


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
        return f"{where} is missing: {KEEP}"
    if kind in ("too_short", "too_long"):
        wanted = fault["ctx"]["min_length" if kind == "too_short" else "max_length"]
        rows = " (3 rows of 3)" if wanted == 9 else ""
        return f"{where} has {len(given)} numbers: it must have {wanted}{rows}"
    if kind == "greater_than":
        return f"{where} is {given}: it must be positive, in pixels"
    if kind == "finite_number":
        return f"{where} is {given}: it must be a finite number, so calibrate again"
    wanted = "rows, cols and data" if kind == "model_type" and where != "roi" else wording(fault)
    return f"{where} is {shown(given)}: it must be {wanted}"
