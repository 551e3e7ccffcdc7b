"""Anti-aliased shapes and text on BGR pictures."""

from __future__ import annotations

import colorsys
from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFont

Colour = tuple[int, int, int]
"""BGR, 0..255."""

PAPER: Colour = (26, 20, 16)
INK: Colour = (235, 230, 225)
DIM: Colour = (165, 155, 145)
GREEN: Colour = (90, 220, 60)
RED: Colour = (70, 60, 240)
BLUE: Colour = (255, 140, 40)

_SHIFT = 4
"""OpenCV draws at 1/16 pixel with this."""


@dataclass(frozen=True, eq=False)
class Canvas:
    """A panel that shows a frame, scaled and placed; draws at the frame's pixels.

    ``image`` H'xW'x3 uint8 BGR; frame pixel (0, 0) begins at (``left``, ``top``).
    """

    image: NDArray[np.uint8]
    scale: float
    left: int
    top: int

    @property
    def height(self) -> int:
        """Rows of the panel."""
        return int(self.image.shape[0])

    @property
    def line_px(self) -> float:
        """Line width that suits the panel's size."""
        return float(np.ceil(max(self.image.shape[:2]) / 480))

    @property
    def text_px(self) -> int:
        """Text height that suits the panel's size."""
        return int(np.clip(self.image.shape[1] / 44, 13, 28))

    def place(self, point: ArrayLike) -> NDArray[np.float64] | None:
        """A frame pixel on the panel, (2,), or None where that is far off or no number."""
        corner = np.array([self.left, self.top]) - 0.5
        xy = (np.asarray(point, dtype=np.float64) + 0.5) * self.scale + corner
        # Far outside, OpenCV's fixed point numbers would overflow.
        return xy if np.isfinite(xy).all() and np.abs(xy).max() < 1e5 else None

    def circle(self, centre: ArrayLike, radius_px: float, colour: Colour) -> None:
        """A ring; ``centre`` in frame pixels, ``radius_px`` on the panel."""
        xy = self.place(centre)
        if xy is None or not 0 < radius_px < 1e4:
            return
        cv2.circle(
            self.image, _fixed(xy), round(radius_px * 2**_SHIFT), colour,
            int(self.line_px), cv2.LINE_AA, _SHIFT,
        )  # fmt: skip

    def arrow(self, start: ArrayLike, end: ArrayLike, colour: Colour) -> None:
        """A line with a dark edge and a dot at its end; frame pixels."""
        a, b = self.place(start), self.place(end)
        if a is None or b is None:
            return
        width = int(self.line_px)
        for line, thickness in ((PAPER, width + 2), (colour, width + 1)):
            cv2.line(self.image, _fixed(a), _fixed(b), line, thickness, cv2.LINE_AA, _SHIFT)
        radius = round((1 + width) * 2**_SHIFT)
        cv2.circle(self.image, _fixed(b), radius, colour, -1, cv2.LINE_AA, _SHIFT)

    def label(self, words: str, point: ArrayLike, to_right: bool, below: bool) -> None:
        """Small text diagonally off ``point`` (frame pixels), kept on the panel."""
        xy = self.place(point)
        if xy is None:
            return
        size = max(10, round(self.text_px * 0.8))
        width = text_width(words, size)
        off = 4.0 + 4 * self.line_px
        x = xy[0] + off if to_right else xy[0] - off - width
        y = xy[1] + (off + size / 2) * (1 if below else -1)
        x = float(np.clip(x, 2, max(2, self.image.shape[1] - width - 2)))
        y = float(np.clip(y, size / 2 + 1, max(size / 2 + 1, self.height - size / 2 - 1)))
        text(self.image, words, (round(x), round(y)), size, INK, halo=True)


def resized(picture: NDArray[np.uint8], scale: float) -> NDArray[np.uint8]:
    """The picture at ``scale``: whole pixels stay crisp when enlarged."""
    if scale == 1.0:
        return picture.copy()
    height, width = picture.shape[:2]
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    how = cv2.INTER_NEAREST if scale > 1 else cv2.INTER_AREA
    return np.asarray(cv2.resize(picture, size, interpolation=how), dtype=np.uint8)


def pure_rgb(hue_deg: float) -> tuple[int, int, int]:
    """The fully saturated, fully bright colour of a hue, as 0..255 RGB."""
    red, green, blue = colorsys.hsv_to_rgb(hue_deg % 360 / 360, 1, 1)
    return round(red * 255), round(green * 255), round(blue * 255)


def swatch(
    image: NDArray[np.uint8],
    corner: tuple[int, int],
    size: tuple[int, int],
    label: str,
    rgb: tuple[int, int, int] | None,
    text_px: int,
) -> None:
    """A labelled rectangle of one colour (``corner`` its top left x, y; ``size`` width,
    height); crossed out where there is no colour."""
    x, y = corner
    width, height = size
    field = image[y : y + height, x : x + width]
    if rgb is None:
        field[:] = (60, 54, 48)
        cv2.line(field, (0, height - 1), (width - 1, 0), DIM, 1, cv2.LINE_AA)
        bright = False
    else:
        field[:] = rgb[::-1]
        bright = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2] > 140
    cv2.rectangle(image, (x - 1, y - 1), (x + width, y + height), DIM, 1)
    ink = PAPER if bright else INK
    left = x + (width - text_width(label, text_px)) // 2
    text(image, label, (left, y + height // 2), text_px, ink)


@cache
def _font(size_px: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size_px)


def text_width(words: str, size_px: int) -> int:
    """Width of a line of text, pixels."""
    return int(np.ceil(_font(size_px).getlength(words)))


def text(
    image: NDArray[np.uint8],
    words: str,
    middle_left: tuple[int, int],
    size_px: int,
    colour: Colour,
    room: int | None = None,
    halo: bool = False,
) -> int:
    """Write one line, made smaller where it is wider than ``room`` pixels.

    ``middle_left`` is x, y of the left end, at half height.  ``halo`` gives it a dark
    edge, to be read on any ground.  Returns the width used.
    """
    if room is not None and room > 0 and words:
        size_px = max(7, min(size_px, int(size_px * room / max(1, text_width(words, size_px)))))
    width = text_width(words, size_px)
    if not words:
        return 0
    edge = max(1, size_px // 8) if halo else 0
    left, top = middle_left[0] - edge, round(middle_left[1] - 0.75 * size_px)
    height = round(size_px * 1.5)
    # Only the patch under the words goes through Pillow.
    x0, y0 = max(left, 0), max(top, 0)
    x1 = min(left + width + 2 * edge, image.shape[1])
    y1 = min(top + height, image.shape[0])
    if x0 >= x1 or y0 >= y1:
        return width
    patch = Image.fromarray(np.ascontiguousarray(image[y0:y1, x0:x1]))
    ImageDraw.Draw(patch).text(
        (left + edge - x0, middle_left[1] - y0), words, fill=colour, font=_font(size_px),
        anchor="lm", stroke_width=edge, stroke_fill=PAPER if halo else None,
    )  # fmt: skip
    image[y0:y1, x0:x1] = np.asarray(patch)
    return width


def _fixed(xy: NDArray[np.float64]) -> tuple[int, int]:
    return round(float(xy[0]) * 2**_SHIFT), round(float(xy[1]) * 2**_SHIFT)
