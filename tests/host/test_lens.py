"""Lens models: against OpenCV's where it has them, against themselves where it has not."""

from __future__ import annotations

import pickle

import cv2
import numpy as np
import pytest

from chromadock import CameraModel
from chromadock.errors import ChromadockError

BENT = [-0.031, 0.0064, -0.0079, 0.0022]
MATRIX = np.array([[300.0, 0, 319.5], [0, 290.0, 239.5], [0, 0, 1]])
FISHEYE = CameraModel(640, 480, MATRIX, np.array(BENT), lens="equidistant")
ALL_AROUND = CameraModel(
    640, 480, np.diag([0.6, 0.6, 1]) @ MATRIX, np.array(BENT) / 9, lens="equidistant"
)
PLAIN = CameraModel(640, 480, MATRIX + np.diag([212, 222, 0]), np.array([-0.2, 0.05, 1e-3, 2e-3]))
WIDE = CameraModel(
    640, 480, MATRIX, np.array([0.6, 0.05, 1e-3, 0, 1e-3, 0.75, 0.12, 5e-3]), name="wide"
)
CAMERAS = {"fisheye": FISHEYE, "all around": ALL_AROUND, "plain": PLAIN, "rational": WIDE}


def directions(most_deg: float, count: int = 300) -> np.ndarray:
    """Points at 0.3 to 5 m within an angle of the axis, some just on it and next to it."""
    rng = np.random.default_rng(0)
    angle, around = np.radians(rng.uniform(0, most_deg, count)), rng.uniform(0, 2 * np.pi, count)
    angle[:4] = 0, 1e-9, 1e-5, 1e-3
    across = np.sin(angle) * np.array([np.cos(around), np.sin(around)])
    return np.column_stack([*across, np.cos(angle)]) * rng.uniform(0.3, 5, (count, 1))


def test_an_equidistant_lens_projects_as_opencvs_fisheye() -> None:
    points, zero = directions(85)[4:], np.zeros(3)
    theirs, _ = cv2.fisheye.projectPoints(points[:, None], zero, zero, MATRIX, np.array(BENT))
    np.testing.assert_allclose(FISHEYE.project(points), theirs[:, 0], atol=1e-9)


@pytest.mark.parametrize("count", [4, 5, 8, 12, 14])
def test_a_pinhole_projects_as_opencv(count: int) -> None:
    """Thin prisms and tilted sensors too; its derivatives by a place are the same."""
    bent = np.array([0.6, 0.05, 1e-3, 2e-3, 1e-3, 0.75, 0.12, 5e-3, 2e-3, -1e-3, 3e-3, 1e-3])
    bent = np.append(bent, [0.03, -0.05])[:count]
    camera = CameraModel(640, 480, MATRIX, bent)
    points, zero = directions(40), np.zeros(3)
    theirs, by = cv2.projectPoints(points, zero, zero, MATRIX, bent)
    pixels, derivatives = camera.optics.project(points)
    np.testing.assert_allclose(pixels, theirs[:, 0], atol=1e-9)
    np.testing.assert_allclose(derivatives, by[:, 3:6].reshape(-1, 2, 3), rtol=1e-9, atol=1e-6)


def test_a_lens_is_copied_without_cs_memory() -> None:
    for camera in CAMERAS.values():
        before, after = camera.optics, pickle.loads(pickle.dumps(camera)).optics
        assert after.native != before.native
        assert after.project(directions(40))[0] == pytest.approx(before.project(directions(40))[0])


def test_an_equidistant_lens_sees_to_the_side_and_behind() -> None:
    """Without coefficients a ray's angle is its pixel's distance: f times 90, 135 degrees."""
    ideal = CameraModel(640, 480, MATRIX, np.zeros(4), lens="equidistant")
    pixels = ideal.project([[2, 0, 0], [0, -1, 0], [1, 0, -1], [0, 0, -1]])
    assert pixels[0] == pytest.approx([319.5 + 300 * np.pi / 2, 239.5])
    assert pixels[1] == pytest.approx([319.5, 239.5 - 290 * np.pi / 2])
    assert pixels[2] == pytest.approx([319.5 + 300 * 3 * np.pi / 4, 239.5])
    assert np.isnan(pixels[3]).all()
    assert ideal.rays(pixels[:3])[2] == pytest.approx(np.array([1, 0, -1]) / np.sqrt(2))
    just_over = ideal.project([[2, 0, -1e-9], [0, -1, -1e-9]])
    assert np.isnan(ideal.undistort([*just_over, pixels[2]])).all()


@pytest.mark.parametrize(("name", "most_deg"), [("fisheye", 88), ("all around", 150)])
def test_rays_and_pixels_of_an_equidistant_lens_are_inverse(name: str, most_deg: float) -> None:
    points, camera = directions(most_deg), CAMERAS[name]
    rays = points / np.linalg.norm(points, axis=1, keepdims=True)
    np.testing.assert_allclose(camera.rays(camera.project(points)), rays, atol=1e-9)
    near = points[points[:, 2] > 0.1]
    tangents = camera.undistort(camera.project(near))
    np.testing.assert_allclose(tangents, near[:, :2] / near[:, 2:], atol=1e-7)


@pytest.mark.parametrize("name", CAMERAS)
def test_derivatives_are_those_of_the_pixels(name: str) -> None:
    camera = CAMERAS[name]
    points = directions({"all around": 150, "fisheye": 88}.get(name, 50))
    pixels, derivatives = camera.optics.project(points)
    np.testing.assert_allclose(pixels, camera.project(points), atol=1e-9)
    for axis, step in enumerate(1e-6 * np.eye(3)):
        ahead, back = (
            camera.optics.project(points + step)[0],
            camera.optics.project(points - step)[0],
        )
        np.testing.assert_allclose(
            derivatives[:, :, axis], (ahead - back) / 2e-6, rtol=1e-4, atol=2e-3
        )


@pytest.mark.parametrize("name", CAMERAS)
def test_ideal_places_are_of_points_as_of_their_pixels(name: str) -> None:
    camera = CAMERAS[name]
    points = directions({"all around": 150, "fisheye": 88}.get(name, 45))
    ideal = camera.optics.ideal_of(points)
    np.testing.assert_allclose(camera.optics.ideal(camera.project(points)), ideal, atol=1e-6)
    rays = points / np.linalg.norm(points, axis=1, keepdims=True)
    np.testing.assert_allclose(camera.optics.rays_of(ideal), rays, atol=1e-9)


@pytest.mark.parametrize("name", CAMERAS)
def test_the_volume_seen_is_that_of_ideal_places_and_log_range(name: str) -> None:
    """By moving points along each of the three, numerically."""
    optics = CAMERAS[name].optics
    points = directions({"all around": 150, "fisheye": 88}.get(name, 60))[4:]
    ideal, depth = optics.ideal_of(points), optics.depth(points)

    def moved(step: np.ndarray) -> np.ndarray:
        rays = optics.rays_of(ideal + step[:2])
        return rays * (depth * np.exp(step[2]) / optics.depth(rays))[:, None]

    columns = [(moved(step) - moved(-step)) / 2e-5 for step in 1e-5 * np.eye(3)]
    volume = np.abs(np.linalg.det(np.array(columns).transpose(1, 0, 2)))
    np.testing.assert_allclose(np.log(volume), optics.log_volume(points), atol=1e-5)


def test_where_the_formula_turns_back_the_picture_of_a_fisheye_ends() -> None:
    """As around the circle of a fisheye that does not fill its frame: no ray, but a place."""
    bent = np.array([0.0, 0.0, -0.02, 0.0])
    fisheye = CameraModel(640, 480, np.diag([0.5, 0.5, 1]) @ MATRIX, bent, lens="equidistant")
    fold = fisheye.optics.fold
    assert fold is not None and fold.angle_rad == pytest.approx((1 / 0.14) ** (1 / 6))
    assert not np.isfinite(fisheye.rays([[639, 479]])).any()
    beyond = fisheye.optics.ideal(np.array([[600.0, 120.0], [639.0, 120.0]]))
    assert np.isfinite(beyond).all() and beyond[1, 0] > beyond[0, 0]
    angle = fold.angle_rad + np.array([-0.01, 0.01])
    pixels = fisheye.project(np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)]))
    assert np.isfinite(pixels[0]).all() and np.isnan(pixels[1]).all()


def test_beyond_the_turn_of_a_pinholes_formula_there_is_no_pixel() -> None:
    """k1 alone brings what is far to the side back to the middle of the picture."""
    camera = CameraModel(640, 480, PLAIN.matrix, np.array([-0.25, 0, 0, 0]))
    fold = camera.optics.fold
    assert fold is not None and np.tan(fold.angle_rad) == pytest.approx(np.sqrt(1 / 0.75))
    pixels = camera.project([[1.1, 0, 1], [1.9, 0, 1]])
    assert np.isfinite(pixels[0]).all() and np.isnan(pixels[1]).all()
    corner = camera.optics.ideal(np.array([[639.0, 470.0], [639.0, 479.0]]))
    assert np.isfinite(corner).all() and 1 > corner[1, 1] > corner[0, 1] > 0.5
    assert np.isnan(camera.rays([[639, 479]])).all()


@pytest.mark.parametrize(
    ("matrix", "distortion", "lens", "says"),
    [
        ([3.6, 3.6], [], "", "far too short"),
        ([3.6, 3.6], [], "equidistant", "far too short"),
        ([512e3, 512e3], [], "", "far too long"),
        ([512, 51.2], [], "", "correct the one that is wrong"),
        ([512, 512], [-0.9, 0, 0, 0], "", "fold the picture 208 px from its middle"),
        ([300, 300], [-0.5, 0, 0, 0], "equidistant", "fold the picture 163 px from its middle"),
        ([300, 300], [0, 0, 0, 0, 0], "equidistant", "5 numbers, but equidistant has 4"),
        ([300, 300], [0, 0, 0, 0], "omni", "lens omni is not supported"),
    ],
)
def test_a_camera_that_cannot_be_is_refused(
    matrix: list[float], distortion: list[float], lens: str, says: str
) -> None:
    K = np.array([[matrix[0], 0, 319.5], [0, matrix[1], 239.5], [0, 0, 1]])
    with pytest.raises(ChromadockError, match=says) as raised:
        CameraModel(640, 480, K, np.array(distortion), "cam.yaml", lens)
    assert "\n" not in str(raised.value) and len(str(raised.value)) < 220


@pytest.mark.parametrize("lens", ["equidistant", "plumb_bob"])
def test_a_wide_lens_that_can_be_is_taken(lens: str) -> None:
    K = np.array([[140.0, 0, 319.5], [0, 140.0, 239.5], [0, 0, 1]])
    assert CameraModel(640, 480, K, np.zeros(4), lens=lens).lens == lens


def test_the_lens_of_a_camera_without_a_name_for_it_goes_by_its_coefficients() -> None:
    assert (PLAIN.lens, WIDE.lens, CameraModel.nominal(8, 6).lens) == (
        "plumb_bob",
        "rational_polynomial",
        "plumb_bob",
    )
