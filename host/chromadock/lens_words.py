"""Which lens a camera file means, under whatever key it says so."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from chromadock.lens import COUNTS
from chromadock.text import one_line

_NAMES: dict[str, tuple[str, ...]] = {
    "plumb_bob": ("plumb_bob", "radtan", "radial_tangential", "brown", "brown_conrady", "opencv"),
    "rational_polynomial": ("rational_polynomial", "rational", "full_opencv"),
    "equidistant": (
        "equidistant",
        "equi",
        "fisheye",
        "opencv_fisheye",
        "kannala_brandt",
        "kannala_brandt4",
        "kannalabrandt4",
        "kb4",
    ),
}
"""The lenses of ``lens.COUNTS`` as ROS, OpenCV, Kalibr, COLMAP and others call them."""

_UNDECIDED = frozenset(("", "none", "null", "pinhole", "perspective", "standard"))
"""What says nothing of the distortion."""

_ABOUT_LENSES = re.compile(
    r"(^|_)(models?|lens|fisheye|camera_type|distortion_type|projection)($|_)"
)
_NOT_ABOUT_LENSES = re.compile(r"matrix|coef|param")
_OTHER_LENSES = re.compile(
    r"fish|^omni($|_|dir)|^mei($|_)|^ds$|double_?sphere|ucm|^fov|^atan|scaramuzza|ocam|f_?theta|"
    r"inverse|modified|kannala|prism|stereographic|equisolid|orthographic|spherical|cylindrical|"
    r"panoram|division"
)
"""Lens models of others, which no formula here is."""


def lens_told(content: Mapping[str, Any]) -> tuple[str, str | None]:
    """The lens that a file's keys tell of, and None; or what is wrong with it, in words.

    Parameters
    ----------
    content
        Keys in lower case.

    Returns
    -------
    One of ``lens.COUNTS``, or empty where the file does not say, and None; for a lens that is
    not supported, or one that two keys have differently, empty and the fault.
    """
    told: dict[str, str] = {}
    unknown: list[str] = []
    for key, value in content.items():
        if not _ABOUT_LENSES.search(key) or _NOT_ABOUT_LENSES.search(key):
            continue
        if isinstance(value, bool | int) and "fisheye" in key:
            value = "fisheye" if value else ""
        if value is not None and not isinstance(value, str):
            continue
        word = re.sub(r"[^a-z0-9]+", "_", (value or "").lower()).strip("_")
        lens = next((name for name, words in _NAMES.items() if word in words), None)
        if lens is not None:
            told[key] = lens
        elif word not in _UNDECIDED:
            shown = f"{key} {one_line(value, 40)}"
            if key.startswith("distortion") or _OTHER_LENSES.search(word):
                return "", f"{shown} is not supported: calibrate with {', '.join(COUNTS)}"
            unknown.append(shown)
    if len(set(told.values())) > 1:
        both = " and ".join(f"{key} says {lens}" for key, lens in told.items())
        return "", f"{both}: keep the one that the calibration was made with"
    if not told and unknown:
        return "", (
            f"{unknown[0]} is no lens known here: "
            f"write distortion_model: {', '.join(COUNTS)}, as the calibration was made with"
        )
    return next(iter(told.values()), ""), None
