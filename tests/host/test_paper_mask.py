from __future__ import annotations

import numpy as np
import pytest

from chromadock.colour.background import background_colour, grey_range
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import observed_colour
from chromadock.paper.mask import colour_mask, foreground


def frame_of(rgb: tuple[int, int, int], shape: tuple[int, int] = (8, 8)) -> np.ndarray:
    return np.full((*shape, 3), rgb[::-1], np.uint8)


def test_the_colour_itself_passes_and_its_opposite_does_not() -> None:
    assert colour_mask(frame_of((143, 160, 201)), (143, 160, 201)).all()
    assert not colour_mask(frame_of((201, 184, 143)), (143, 160, 201)).any()


@pytest.mark.parametrize("centre_deg", [0, 10, 59, 61, 120, 240, 300, 350, 359])
def test_the_hue_window_is_sixty_degrees_either_way_and_wraps(centre_deg: int) -> None:
    def pure(deg: float) -> tuple[int, int, int]:
        return rgb_from_hsv(round(deg % 360 * 1536 / 360) % 1536, 255, 255)

    for apart, passes in ((0, True), (57, True), (-57, True), (63, False), (-63, False)):
        mask = colour_mask(frame_of(pure(centre_deg + apart)), pure(centre_deg))
        assert mask.any() == passes, apart


@pytest.mark.parametrize(
    ("value", "passes"), [(155, True), (154, False), (245, True), (246, False)]
)
def test_the_value_window_is_45_of_255(value: int, passes: bool) -> None:
    # Pure red at V 200: V passes from 155 to 245.
    assert colour_mask(frame_of((value, 0, 0)), (200, 0, 0)).any() == passes


@pytest.mark.parametrize(("low", "passes"), [(45, True), (47, False)])
def test_the_saturation_window_is_cut_off_at_one(low: int, passes: bool) -> None:
    # S of (255, low, low) is 255 - low; the centre is fully saturated.
    assert colour_mask(frame_of((255, low, low)), (255, 0, 0)).any() == passes


def test_foreground_is_what_has_another_grey_than_the_water() -> None:
    frame = frame_of((60, 60, 60), (40, 40))
    frame[:, 20:] = 200
    inside = foreground(frame, background_bin=1)
    assert not inside[:, :17].any()
    assert inside[:, 23:].all()


def test_the_printed_mask_cannot_see_the_expected_colour_in_pool_blue() -> None:
    """The example of docs/method.md: the expected colour has the water's own grey interval."""
    water, marker = (38, 138, 188), (255, 0, 170)
    observed = observed_colour(water, marker)
    assert observed == (147, 138, 188)
    greys = [background_colour(np.array([[rgb]], np.uint8)).bin for rgb in (water, observed)]
    assert greys == [2, 2]


def test_the_five_grey_ranges_are_equal_and_leave_no_gap() -> None:
    ranges = [grey_range(b) for b in range(5)]
    assert ranges == [(0, 51), (52, 102), (103, 153), (154, 204), (205, 255)]
    assert all(g * 5 >> 8 == b for b, (low, high) in enumerate(ranges) for g in (low, high))


def test_the_observed_colour_is_half_and_half_but_never_darker_than_the_water() -> None:
    assert observed_colour((31, 160, 201), (255, 0, 191)) == (143, 160, 201)
    assert observed_colour((0, 0, 0), (255, 255, 255)) == (128, 128, 128)
    assert observed_colour((200, 100, 50), (0, 0, 0)) == (200, 100, 50)
