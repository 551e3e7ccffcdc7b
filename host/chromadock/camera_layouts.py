"""The layouts of camera files that are read, and those that are known by name only."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, Field

from chromadock.camera_window import Calibration, Roi

_Number = Annotated[float, Field(allow_inf_nan=False)]
_Nine = Annotated[list[_Number], Field(min_length=9, max_length=9)]
_Pixels = Annotated[int, Field(gt=0)]
_Count = Annotated[int, Field(ge=0)]

KEEP = "give the camera_info YAML of your calibration"


class _Matrix(BaseModel):
    data: _Nine


class _Coefficients(BaseModel):
    data: list[_Number]


class _Windowed(BaseModel):
    """Only the keys that are used; calibration tools write many more."""

    binning_x: _Count | None = None
    binning_y: _Count | None = None
    roi: Roi | None = None

    @property
    def binning(self) -> tuple[int, int]:
        """Pixels along x and y that make one."""
        return self.binning_x or 1, self.binning_y or 1


class CameraInfoFile(_Windowed):
    """``camera_info`` YAML as ROS's calibration tools write it; OpenCV's own is the same."""

    image_width: _Pixels
    image_height: _Pixels
    camera_matrix: _Matrix
    distortion_coefficients: _Coefficients

    def full(self, lens: str) -> Calibration:
        """Of the full sensor."""
        return _calibration(
            (self.image_width, self.image_height),
            self.camera_matrix.data,
            self.distortion_coefficients.data,
            lens,
        )


class CameraInfoMessage(_Windowed):
    """sensor_msgs/CameraInfo as ``ros2 topic echo`` and ``rostopic echo`` print it."""

    width: _Pixels
    height: _Pixels
    d: list[_Number]
    k: _Nine

    def full(self, lens: str) -> Calibration:
        """Of the full sensor."""
        return _calibration((self.width, self.height), self.k, self.d, lens)


class KalibrCamera(_Windowed):
    """One ``cam0`` of Kalibr's camchain: fx fy cx cy, and no window."""

    intrinsics: Annotated[list[_Number], Field(min_length=4, max_length=4)]
    distortion_coeffs: list[_Number]
    resolution: Annotated[list[_Pixels], Field(min_length=2, max_length=2)]

    def full(self, lens: str) -> Calibration:
        """Of the full sensor."""
        fx, fy, cx, cy = self.intrinsics
        width, height = self.resolution
        matrix = [fx, 0, cx, 0, fy, cy, 0, 0, 1]
        return _calibration((width, height), matrix, self.distortion_coeffs, lens)


Layout = CameraInfoFile | CameraInfoMessage | KalibrCamera


def layout_of(content: Mapping[str, Any]) -> type[Layout]:
    """Which layout the keys, in lower case, are of; ``camera_info`` unless they tell another."""
    if "intrinsics" in content:
        return KalibrCamera
    if "k" in content and "width" in content:
        return CameraInfoMessage
    return CameraInfoFile


def kalibr_cameras(content: Mapping[str, Any]) -> list[str]:
    """The keys of the cameras in Kalibr's camchain; empty for another layout."""
    return [k for k, v in content.items() if re.fullmatch(r"cam\d+", k) and isinstance(v, dict)]


def foreign_text(text: str) -> str | None:
    """Whose file a text is that is not read, with the mend, or None."""
    start = text.lstrip()[:400]
    if start.startswith("<"):
        kind = "OpenCV's XML" if "opencv_storage" in start else "an XML file"
        return f"{kind} is not read: have it written as YAML (a name that ends in .yml)"
    if re.match(r"(#[^\n]*\n\s*)*\[\w+\]\s*\n", start):
        return "an .ini file is not read: give the .yaml that ROS's calibrator writes beside it"
    return None


def foreign_keys(content: Mapping[str, Any]) -> str | None:
    """Whose layout the keys, in lower case, are of that is not read, with the mend, or None."""
    if "camera_matrix" in content or "k" in content:
        return None
    for pattern, whose in _FOREIGN:
        if any(re.match(pattern, key) for key in content):
            return f"{whose} is not read: write its numbers as camera_info YAML"
    return None


_FOREIGN = (
    (r"camera\d?\.", "the settings file of ORB-SLAM"),
    (r"(projection|mirror|affine)_parameters$", "the camera file of VINS (camodocal)"),
    (r"value0$", "the calibration of Basalt"),
    (r"cameras$", "a rig of several cameras"),
    (r"m1$|m2$", "OpenCV's stereo calibration, which has no picture size,"),
)


def _calibration(
    size: tuple[int, int], matrix: list[float], distortion: list[float], lens: str
) -> Calibration:
    K = np.array(matrix, dtype=np.float64).reshape(3, 3)
    return Calibration(*size, K, np.array(distortion, dtype=np.float64), lens)
