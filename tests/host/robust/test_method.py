from __future__ import annotations

from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import pytest
from lit import to_linear
from robust_composites import CAMERA, DOCK, Water, add_lamp, compose, photographed

from chromadock import CameraModel, DockGeometry
from chromadock.colour.background import background_colour
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import smooth, working_image
from chromadock.geometry.pose import Estimate
from chromadock.look import Found, Look
from chromadock.robust.method import RobustMethod
from chromadock.stopwatch import Stopwatch

FIVE = DockGeometry(
    (*DOCK.names, "front"), np.vstack([DOCK.points, (0.0, 0.0, -0.3)]), "five markers"
)
LEVEL = np.eye(3)


def water(seed: int = 0, shape: tuple[int, int] = (480, 640)) -> np.ndarray:
    """Blue-green, brighter above, with a camera's noise."""
    rng = np.random.default_rng(seed)
    light = np.linspace(1.2, 0.8, shape[0])[:, None, None] * np.array([190.0, 140.0, 40.0])
    return np.clip(light + rng.normal(0, 2, (*shape, 3)), 0, 255).astype(np.uint8)


def looked(
    frame: np.ndarray, camera: CameraModel = CAMERA, priors: tuple[Estimate, ...] = ()
) -> Look:
    seen = background_colour(smooth(working_image(np.ascontiguousarray(frame[..., ::-1]))))
    return Look(frame, seen, marker_hue(seen, "ternary"), camera, priors)


def look(
    frame: np.ndarray,
    dock: DockGeometry = DOCK,
    camera: CameraModel = CAMERA,
    prior: Estimate | None = None,
) -> Found:
    priors = () if prior is None else (prior,)
    return RobustMethod(dock).find(looked(frame, camera, priors), Stopwatch())


def lit(
    places: list[tuple[np.ndarray, float]], seed: int = 0, attenuation: float = 0.4
) -> np.ndarray:
    """Water with lamps at (points in the camera frame (n, 3), share of their light)."""
    rng = np.random.default_rng(seed)
    rgb = water(seed)[..., ::-1]
    seen = Water.of(rgb, rng)
    light = to_linear(rgb)
    for points, share in places:
        shone = Water(np.full(3, attenuation), seen.veil, seen.lamp * share)
        for point in points:
            add_lamp(light, shone, CAMERA.project(point)[0], float(np.linalg.norm(point)))
    return photographed(light, rng)


def off_by(found: Found, pixels: np.ndarray, dock: DockGeometry = DOCK) -> float:
    assert found.markers is not None
    return max(
        float(np.hypot(*np.subtract(found.markers[name], pixel)))
        for name, pixel in zip(dock.names, pixels, strict=True)
    )


@pytest.mark.parametrize("range_m", [1.0, 2.0, 3.5])
def test_a_dock_is_found_where_it_is(range_m: float) -> None:
    for seed in range(3):
        scene = compose(water(seed), range_m, np.random.default_rng(seed))
        found = look(scene.frame_bgr)
        assert found.state == "found"
        assert off_by(found, scene.pixels) < 1.5
        assert found.pose is not None
        assert np.linalg.norm(found.pose.t) == pytest.approx(range_m, rel=0.02)
        assert found.evidence is not None and found.evidence > 1.5
        assert found.estimates[0].pose(found.pose.alternative) == found.pose


def test_plain_water_holds_no_dock() -> None:
    for seed in range(5):
        found = look(water(seed))
        assert found.state == "not_found"
        assert found.markers is None and found.pose is None and not found.estimates


def test_a_frame_too_small_for_any_dock_holds_none() -> None:
    assert look(water(shape=(60, 80)), camera=CameraModel.nominal(80, 60)).state == "not_found"


def test_a_dock_with_depth_is_found_and_its_attitude_is_far_better(record_property: Any) -> None:
    errors: dict[int, list[float]] = {4: [], 5: []}
    for dock in (DOCK, FIVE):
        for seed in range(10):
            scene = compose(water(seed), 3.0, np.random.default_rng([9, seed]), dock)
            found = look(scene.frame_bgr, dock)
            if found.state != "found":
                continue
            assert off_by(found, scene.pixels, dock) < 3
            turn = cv2.Rodrigues(found.estimates[0].R @ scene.R.T)[0]
            errors[len(dock.names)].append(float(np.degrees(np.linalg.norm(turn))))
    assert min(len(e) for e in errors.values()) >= 8
    four, five = (float(np.median(errors[n])) for n in (4, 5))
    record_property("figure", f"attitude at 3 m: rectangle {four:.1f} deg, five markers {five:.2f}")
    assert five < four / 3


def test_of_a_dock_and_its_image_in_the_surface_the_lower_is_taken() -> None:
    """The image is brighter here: waves happen to focus it."""
    for seed, height in enumerate((0.5, 0.8, 1.1)):
        below = DOCK.points + np.array([0.1, 0.35, 2.5])
        image = below * (1, -1, 1) + (0, 0.7 - height, 0)
        found = look(lit([(below, 0.6), (image, 1.0)], seed))
        assert found.state == "found"
        assert off_by(found, CAMERA.project(below)) < 2
        assert off_by(look(lit([(image, 1.0)], seed)), CAMERA.project(image)[[2, 3, 0, 1]]) < 2


def test_two_docks_side_by_side_are_no_image_of_each_other() -> None:
    left, right = (DOCK.points * 0.999 + (x, 0.3 * x, 4.0) for x in (-0.9, 0.9))
    found = look(lit([(left, 0.5), (right, 1.0)]))
    assert found.state == "found"
    assert off_by(found, CAMERA.project(right)) < 2


def test_with_a_marker_out_there_is_a_pose_only_where_one_is_expected() -> None:
    t = np.array([0.2, 0.1, 2.5])
    points = DOCK.points + t
    sure = Estimate(
        LEVEL, t + np.array([0.04, -0.03, 0.06]), 0, 0, np.diag([400.0, 400, 100, 100, 100, 100])
    )
    for missing in range(4):
        frame = lit([(np.delete(points, missing, axis=0), 1.0)], missing)
        assert look(frame).state == "not_found"
        found = look(frame, prior=sure)
        assert found.state == "partial"
        assert found.markers is not None
        assert set(found.markers) == set(DOCK.names) - {DOCK.names[missing]}
        assert found.pose is not None
        assert found.pose.t == pytest.approx(tuple(t), abs=0.08)


def test_a_wrong_expectation_does_not_hide_the_dock() -> None:
    points = DOCK.points + np.array([0.2, 0.1, 2.5])
    wrong = Estimate(LEVEL, np.array([-0.6, 0.2, 4.0]), 0, 0, np.diag([400.0] * 3 + [100.0] * 3))
    found = look(lit([(points, 1.0)]), prior=wrong)
    assert found.state == "found"
    assert off_by(found, CAMERA.project(points)) < 2


@pytest.mark.parametrize("specks", [25, 200])
def test_specks_of_the_markers_colour_are_no_dock(specks: int) -> None:
    rng = np.random.default_rng(specks)
    for seed in range(4):
        spots = rng.uniform((10, 10), (630, 470), (specks, 2))
        rays = np.column_stack([CAMERA.undistort(spots), np.ones(specks)])
        frame = lit([(rays * rng.uniform(2, 5, (specks, 1)), 1.0)], seed)
        assert look(frame).state == "not_found"


def test_the_mask_holds_the_pixels_that_stand_out() -> None:
    method = RobustMethod(DOCK)
    assert method.mask.shape == (0, 0)
    scene = compose(water(), 2.0, np.random.default_rng(4))
    found = method.find(looked(scene.frame_bgr), Stopwatch())
    assert method.mask.shape == (480, 640)
    assert found.passed_fraction == pytest.approx(method.mask.mean())
    assert all(method.mask[round(y), round(x)] for x, y in scene.pixels.tolist())


def test_markers_are_reported_as_blobs_before_others() -> None:
    scene = compose(water(), 2.0, np.random.default_rng(4))
    found = look(scene.frame_bgr)
    assert found.markers is not None
    assert [b.accepted for b in found.blobs[:5]] == [True] * 4 + [False]
    assert [(b.x, b.y) for b in found.blobs[:4]] == list(found.markers.values())
    for other in found.blobs[4:]:  # and not a second time among the others
        assert all(np.hypot(other.x - b.x, other.y - b.y) > 4 for b in found.blobs[:4])


@pytest.mark.parametrize("size", [(320, 240), (1280, 720)])
def test_other_cameras_find_it_too(size: tuple[int, int]) -> None:
    scene = compose(water(), 1.6, np.random.default_rng(5))
    scale = size[0] / 640
    frame = cv2.resize(scene.frame_bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    frame = frame[: size[1]]
    matrix = CAMERA.matrix.copy()
    matrix[:2] *= scale
    matrix[:2, 2] += (scale - 1) / 2
    camera = CameraModel(frame.shape[1], frame.shape[0], matrix)
    found = look(frame, camera=camera)
    if (camera.project(DOCK.points @ scene.R.T + scene.t)[:, 1] < frame.shape[0] - 20).all():
        assert found.state == "found"
        assert found.pose is not None
        assert np.linalg.norm(found.pose.t) == pytest.approx(1.6, rel=0.02)


@pytest.mark.parametrize(("turn", "state"), [((0.1, 0.2, 0.0), "partial"), ((1.0, 1.1, 0.5), None)])
def test_three_lamps_are_a_dock_with_a_marker_out_only_if_it_is_turned_as_docks_are(
    turn: tuple[float, float, float], state: str | None
) -> None:
    """Two floats and a lamp stand as three markers of a dock would that is turned by 60 degrees:
    the search knows the shapes of three places roughly only."""
    R = cv2.Rodrigues(np.array(turn))[0]
    frame = lit([(DOCK.points[1:] @ R.T + (0.1, 0.05, 2.5), 1.0)])
    found = RobustMethod(DOCK).find(replace(looked(frame), incomplete=True), Stopwatch())
    if state is None:
        assert found.markers is None
    else:
        assert found.markers is not None and set(found.markers) == set(DOCK.names[1:])
