from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock.paper.blobs import MAX_BLOBS, find_spots


def empty() -> np.ndarray:
    return np.zeros((480, 640), np.uint8)


@pytest.mark.parametrize("radius", [2, 3, 5, 8, 12, 18])
@pytest.mark.parametrize("centre", [(300, 200), (25, 30), (614, 450)])
def test_a_disc_is_one_spot_at_its_centre(radius: int, centre: tuple[int, int]) -> None:
    mask = empty()
    cv2.circle(mask, centre, radius, 255, -1)
    spots = find_spots(mask)
    assert len(spots) == 1
    assert np.hypot(spots[0].x - centre[0], spots[0].y - centre[1]) < 0.5 + radius / 50
    assert radius / 1.5 < spots[0].radius < 1.5 * radius + 3  # the mask is widened by two


def test_a_ring_about_a_clipped_core_is_one_spot_at_its_centre() -> None:
    mask = empty()
    cv2.circle(mask, (100, 100), 4, 255, 2)
    spots = find_spots(mask)
    assert len(spots) == 1
    assert np.hypot(spots[0].x - 100, spots[0].y - 100) < 0.5


def test_the_middle_of_a_long_bar_is_no_spot() -> None:
    mask = empty()
    cv2.rectangle(mask, (50, 200), (600, 206), 255, -1)
    assert all(not 100 < s.x < 550 for s in find_spots(mask))


def test_single_pixels_are_noise() -> None:
    mask = empty()
    mask[50::97, 50::89] = 255
    assert find_spots(mask) == []


def test_an_empty_and_a_full_mask_have_no_spots() -> None:
    assert find_spots(empty()) == []
    assert find_spots(empty() + np.uint8(255)) == []


def test_masks_of_one_pixel_and_one_row_are_searched() -> None:
    assert find_spots(np.full((1, 1), 255, np.uint8)) == []
    assert find_spots(np.full((1, 50), 255, np.uint8)) == []


def test_a_frame_full_of_specks_costs_a_bounded_number_of_spots() -> None:
    mask = empty()
    for y in range(10, 470, 20):
        for x in range(10, 630, 20):
            cv2.circle(mask, (x, y), 3, 255, -1)
    assert len(find_spots(mask)) == MAX_BLOBS
