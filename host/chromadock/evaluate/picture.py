"""The sample frame of a run: the picture, what each filter made of it, the colours chosen."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.colour.hsv import degrees, hsv_from_rgb
from chromadock.draw import GREEN, RED, Canvas, pure_rgb
from chromadock.results.detection import RGB, Blob

_QUALITY = 90


def frame_jpeg(frame_bgr: NDArray[np.uint8]) -> bytes:
    """The frame as it is."""
    return _encoded(".jpg", frame_bgr, [cv2.IMWRITE_JPEG_QUALITY, _QUALITY])


def mask_png(frame_bgr: NDArray[np.uint8], mask: NDArray[np.uint8], blobs: Sequence[Blob]) -> bytes:
    """What passed on black; a green ring about blobs that the spatial filter took, red others."""
    picture = np.where(mask[:, :, None] != 0, frame_bgr, np.uint8(0)).astype(np.uint8)
    canvas = Canvas(picture, 1.0, 0, 0)
    for blob in blobs:
        canvas.circle((blob.x, blob.y), blob.radius + 4, GREEN if blob.accepted else RED)
    return _encoded(".png", picture, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def swatches_json(sides: Mapping[str, tuple[RGB, float]]) -> bytes:
    """For each side, from the water's colour and the marker's hue (0..360): the water's
    colour, its pure hue and the marker's colour, each [r, g, b], 0..255."""
    content = {
        side: {
            "background": list(background),
            "pure": list(pure_rgb(_hue_deg(background))),
            "marker": list(pure_rgb(marker_hue_deg)),
        }
        for side, (background, marker_hue_deg) in sides.items()
    }
    return json.dumps(content).encode()


def _hue_deg(rgb: RGB) -> float:
    return degrees(int(hsv_from_rgb(np.array(rgb, np.uint8))[0]))


def _encoded(suffix: str, picture: NDArray[np.uint8], options: list[int]) -> bytes:
    return bytes(cv2.imencode(suffix, picture, options)[1])
