from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock import method
from chromadock.colour.working_image import RGB565_SCALE, RGB888_SCALE, working_image

CELLS = (method.WORKING_HEIGHT, method.WORKING_WIDTH)


def by_definition(pixels: np.ndarray, scale: tuple[int, int, int]) -> np.ndarray:
    """Python's integers, box by box: halves up."""
    rows, columns = pixels.shape[0] // CELLS[0], pixels.shape[1] // CELLS[1]
    out = np.empty((*CELLS, 3), np.uint8)
    for y in range(CELLS[0]):
        for x in range(CELLS[1]):
            box = pixels[rows * y : rows * (y + 1), columns * x : columns * (x + 1)]
            for channel in range(3):
                total, full = (
                    sum(box[..., channel].ravel().tolist()),
                    scale[channel] * box[..., 0].size,
                )
                out[y, x, channel] = (2 * 255 * total + full) // (2 * full)
    return out


@pytest.mark.parametrize("size", [(60, 80), (120, 160), (180, 80), (60, 240), (240, 320)])
@pytest.mark.parametrize("scale", [RGB888_SCALE, RGB565_SCALE])
def test_the_fast_average_is_the_definition(
    size: tuple[int, int], scale: tuple[int, int, int]
) -> None:
    rng = np.random.default_rng(size)
    pixels = rng.integers(0, np.array(scale) + 1, (*size, 3)).astype(np.uint8)
    assert np.array_equal(working_image(pixels, scale), by_definition(pixels, scale))


def test_every_sum_of_a_cell_is_rounded_once_halves_up() -> None:
    """All 4 x 255 + 1 sums of four pixels in each channel, each in a cell of its own."""
    sums = np.arange(60 * 80) % (4 * 255 + 1)
    pixels = np.zeros((120, 160, 3), np.uint8)
    parts = np.minimum(np.maximum(sums[:, None] - 255 * np.arange(4), 0), 255)
    pixels.reshape(60, 2, 80, 2, 3)[:] = parts.reshape(60, 80, 2, 2, 1).transpose(0, 2, 1, 3, 4)
    expected = np.floor(sums / 4 + 0.5).reshape(60, 80)
    assert np.array_equal(working_image(pixels), np.repeat(expected[..., None], 3, axis=2))


def test_the_largest_frame_does_not_overflow() -> None:
    pixels = np.full((method.MAX_FRAME_HEIGHT, method.MAX_FRAME_WIDTH, 3), 255, np.uint8)
    assert (working_image(pixels) == 255).all()


@pytest.mark.parametrize(
    "size", [(480, 640), (61, 83), (59, 79), (7, 5), (1, 1), (479, 1281), (60 * 300, 80)]
)
def test_each_cell_of_a_frame_of_any_size_has_the_pixels_that_it_covers(
    size: tuple[int, int],
) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (*size, 3), np.uint8)
    averaged = working_image(pixels)
    for y in range(0, CELLS[0], 7):
        top, bottom = y * size[0] // CELLS[0], (y + 1) * size[0] // CELLS[0]
        for x in range(0, CELLS[1], 7):
            left, right = x * size[1] // CELLS[1], (x + 1) * size[1] // CELLS[1]
            box = pixels[top : max(bottom, top + 1), left : max(right, left + 1)].reshape(-1, 3)
            total, count = box.sum(axis=0, dtype=np.int64), len(box)
            assert averaged[y, x].tolist() == ((2 * total + count) // (2 * count)).tolist()


def test_a_view_of_a_frame_counts_like_its_copy() -> None:
    frame = np.random.default_rng(2).integers(0, 256, (480, 640, 3), np.uint8)
    for view in (frame[..., ::-1], frame[:, ::-1], cv2.flip(frame, 0)):
        assert np.array_equal(working_image(view), working_image(np.ascontiguousarray(view)))
