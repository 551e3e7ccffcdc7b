"""What of a sensor a camera's pictures show: region of interest and binning of a CameraInfo.

By ROS's sensor_msgs/CameraInfo (REP 104) sizes and intrinsics are of the full sensor; the region
is in its pixels, and ``binning`` makes one pixel of so many in a row and in a column.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field

_Count = Annotated[int, Field(ge=0)]


@dataclass(frozen=True, eq=False, slots=True)
class Calibration:
    """What a camera file has: ``matrix`` (3, 3), ``distortion`` (n,), ``lens`` one of
    ``lens.COUNTS`` or empty; ``window``: words for a part of the sensor, empty for all of it."""

    width: int
    height: int
    matrix: NDArray[np.float64]
    distortion: NDArray[np.float64]
    lens: str
    window: str = ""


class Roi(BaseModel):
    """Pixels of the full sensor; all 0 for the whole of it."""

    x_offset: _Count = 0
    y_offset: _Count = 0
    width: _Count = 0
    height: _Count = 0


def windowed(full: Calibration, roi: Roi, binning: tuple[int, int]) -> Calibration | str:
    """The calibration of the pictures that come of a full sensor's, or what is wrong, in words.

    Pixel 0 has its middle at 0 in both: of binned pixels the middle is between those that make it.
    """
    sides = (full.width, full.height)
    offset, size = (roi.x_offset, roi.y_offset), (roi.width, roi.height)
    if not any(size) and any(offset):
        return f"roi begins at {_by(offset)} but has no width and height: give both, or remove roi"
    size = size if any(size) else sides
    ends = (offset[0] + size[0], offset[1] + size[1])
    if not all(size) or ends[0] > sides[0] or ends[1] > sides[1]:
        return (
            f"roi is {_by(size)} at {_by(offset)}, not within the {_by(sides)} of image_width and "
            "image_height, which are the full sensor's: correct those, or remove roi if the "
            "calibration is of the pictures as they are"
        )
    by = np.maximum(binning, 1)
    if size == sides and (by == 1).all():
        return full
    if (by > size).any():
        return f"binning is {_by(by)} of {_by(size)} pixels: correct binning_x and binning_y"
    matrix = full.matrix.copy()
    matrix[:2, 2] = (matrix[:2, 2] - offset + 0.5) / by - 0.5
    matrix[[0, 1], [0, 1]] /= by
    words = [f"roi {_by(size)} at {_by(offset)}"] if size != sides else []
    words += [f"binning {_by(by)}"] if (by > 1).any() else []
    return replace(
        full,
        width=size[0] // int(by[0]),
        height=size[1] // int(by[1]),
        matrix=matrix,
        window=f" ({', '.join(words)} of {_by(sides)})",
    )


def _by(pair: tuple[int, int] | NDArray[np.int_]) -> str:
    return f"{pair[0]}x{pair[1]}"
