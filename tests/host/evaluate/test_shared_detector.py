"""The filters share the paper's detector: faster than it was written down, same to the bit."""

from __future__ import annotations

import itertools

import cv2
import numpy as np
import pytest
from composites import CAMERA, DOCK, compose

from chromadock import Detector
from chromadock.paper.constellation import (
    ANGLE_TOLERANCE_DEG,
    RATIO_TOLERANCE,
    four_blobs,
    right_triangles,
)
from chromadock.paper.method import PaperMethod
from chromadock.paper.peaks import MIN_RESPONSE, SIGMAS, find_peaks
from chromadock.stopwatch import Stopwatch


def plain_peaks(mask: np.ndarray) -> list[tuple[float, float, float, float]]:
    """Every scale over the whole mask, every cell compared with its neighbours."""
    unit = mask.astype(np.float32) / 255
    peaks = []
    for sigma in SIGMAS:
        step = 1 << max(0, int(np.log2(sigma)) - 1)
        size = (max(1, unit.shape[1] // step), max(1, unit.shape[0] // step))
        grid = unit if step == 1 else cv2.resize(unit, size, interpolation=cv2.INTER_AREA)
        blurred = cv2.GaussianBlur(grid, (0, 0), sigma / step)
        response = -((sigma / step) ** 2) * cv2.Laplacian(blurred, cv2.CV_32F)
        highest = response == cv2.dilate(response, np.ones((3, 3), np.uint8))
        scale_x, scale_y = unit.shape[1] / size[0], unit.shape[0] / size[1]
        for y, x in np.argwhere(highest & (response >= MIN_RESPONSE)):
            place = ((x + 0.5) * scale_x - 0.5, (y + 0.5) * scale_y - 0.5)
            peaks.append((*place, float(np.sqrt(2) * sigma), float(response[y, x])))
    return peaks


def random_mask(rng: np.random.Generator) -> np.ndarray:
    """Discs and rings, specks of any density, patches; of any size."""
    height, width = (480, 640) if rng.random() < 0.3 else rng.integers(1, 500, 2)
    mask = np.zeros((height, width), np.uint8)
    for _ in range(rng.integers(0, 25)):
        centre = (int(rng.integers(0, width)), int(rng.integers(0, height)))
        cv2.circle(mask, centre, int(rng.integers(0, 25)), 255, int(rng.choice([-1, 1, 2])))
    mask[rng.random(mask.shape) < rng.choice([0, 1e-5, 1e-4, 1e-3, 1e-2, 0.1])] = 255
    if rng.random() < 0.2:
        noise = cv2.GaussianBlur(rng.normal(size=mask.shape), (0, 0), 2)
        mask[noise > rng.choice([0.1, 0.2, 0.4])] = 255
    return mask


def test_peaks_are_those_of_the_whole_mask_whatever_is_left_out() -> None:
    rng = np.random.default_rng(6)
    found = 0
    for _ in range(120):
        mask = random_mask(rng)
        peaks = [(p.x, p.y, p.radius, p.response) for p in find_peaks(mask)]
        assert peaks == plain_peaks(mask)
        found += len(peaks)
    assert found > 1000


def plain_right_triangles(points: np.ndarray, ratio: float) -> np.ndarray:
    error = np.full((len(points),) * 3, np.inf)
    for a, b, c in itertools.permutations(range(len(points)), 3):
        long, short = points[b] - points[a], points[c] - points[a]
        lengths = np.hypot(*long), np.hypot(*short)
        if min(lengths) == 0:
            continue
        angle = abs(long @ short) / (lengths[0] * lengths[1])
        angle /= np.sin(np.radians(ANGLE_TOLERANCE_DEG))
        off = abs(lengths[0] / lengths[1] / ratio - 1) / RATIO_TOLERANCE
        if angle <= 1 and off <= 1:
            error[a, b, c] = angle**2 + off**2
    return error


def plain_four_blobs(error: np.ndarray) -> tuple[int, ...] | None:
    best, least = None, np.inf
    for a, b, c, d in itertools.product(range(len(error)), repeat=4):
        total = error[a, b, c] + error[b, a, d] + error[c, d, a] + error[d, c, b]
        if total < least:
            best, least = (a, b, c, d), total
    return best


def test_triangles_and_the_best_four_are_those_of_trying_all() -> None:
    rng = np.random.default_rng(8)
    rectangle = np.array([(0, 0), (70, 0), (0, 10), (70, 10)])
    four = 0
    for k in range(60):
        points = rng.uniform(0, 200, (rng.integers(0, 8), 2))
        if k % 2:
            shift = rng.uniform(0, 100, 2) + rng.normal(0, 1, (4, 2))
            points = np.concatenate([points, rng.uniform(1, 3) * rectangle + shift])
        error = right_triangles(points, 7.0)
        np.testing.assert_allclose(error, plain_right_triangles(points, 7.0), atol=1e-9)
        assert four_blobs(error) == plain_four_blobs(error)
        four += four_blobs(error) is not None
    assert four > 15


def test_a_mask_of_any_filter_goes_the_detectors_way() -> None:
    seen = compose(np.full((480, 640, 3), (200, 150, 52), np.uint8), 2.0, np.random.default_rng(4))
    detector = Detector(CAMERA, DOCK, method="paper", independent=True)
    detection = detector.process(seen.frame_bgr, 0.0)
    mask = np.where(detector.mask, 255, 0).astype(np.uint8)
    found = PaperMethod(DOCK).find_in_mask(mask, CAMERA, Stopwatch())
    assert detection.found
    assert (found.pose, found.markers, found.blobs) == (
        detection.pose,
        detection.markers,
        detection.blobs,
    )
    nothing = PaperMethod(DOCK).find_in_mask(np.zeros_like(mask), CAMERA, Stopwatch())
    assert nothing.pose is None
    assert nothing.passed_fraction == 0


@pytest.mark.parametrize("count", [0, 1, 3])
def test_fewer_than_four_points_are_no_dock(count: int) -> None:
    points = np.arange(2.0 * count).reshape(count, 2) ** 2
    assert four_blobs(right_triangles(points, 7.0)) is None
