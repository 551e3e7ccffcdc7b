from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock.rotation import matrix_from_quaternion, quaternion_from_matrix
from chromadock.sim.motion import Bobbing, Course, Motion
from chromadock.sim.transform import Transform, level, looking, turned

AXES = {"north": [1, 0, 0], "east": [0, 1, 0], "down": [0, 0, 1]}


def hold(distance_m: float, **rest: object) -> Motion:
    return Motion(1.0, course=Course(distance_m, distance_m, 1.0), **{"heading_deg": 0.0, **rest})


def homogeneous(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R, t
    return matrix


def about(axis: str, degrees: float) -> np.ndarray:
    """A rotation by Rodrigues' formula, as OpenCV has it."""
    unit = np.eye(3)["xyz".index(axis)]
    return cv2.Rodrigues(np.radians(degrees) * unit)[0]


@pytest.mark.parametrize(
    ("heading", "right", "forward"),
    [
        (0, "east", "north"),
        (90, "-north", "east"),
        (180, "-east", "-north"),
        (270, "north", "-east"),
    ],
)
def test_a_level_body_on_a_heading(heading: float, right: str, forward: str) -> None:
    R = level(heading)
    for column, name in enumerate((right, "down", forward)):
        wanted = np.array(AXES[name.lstrip("-")]) * (-1 if name.startswith("-") else 1)
        np.testing.assert_allclose(R[:, column], wanted, atol=1e-12)


def test_rotations_are_rodrigues_about_turned_axes() -> None:
    wanted = about("y", 20) @ about("x", -7) @ about("z", 33)
    np.testing.assert_allclose(turned(20, -7, 33), wanted, atol=1e-12)
    R = looking([0.3, -0.4, 1.7])
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1)
    np.testing.assert_allclose(R @ [0, 0, np.linalg.norm([0.3, 0.4, 1.7])], [0.3, -0.4, 1.7])
    assert R[1, 0] == 0  # level: the right side is neither up nor down


def test_the_dock_in_the_camera_is_the_composition_of_both_in_the_world() -> None:
    """By 4x4 matrices, Rodrigues and a look-at written from the frames' definitions."""
    motion = Motion(
        depth_m=2.0,
        heading_deg=130.0,
        course=Course(4.0, 1.0, 10.0),
        offset_right_m=0.7,
        offset_down_m=-0.4,
        aim_yaw_deg=5.0,
        aim_pitch_deg=-3.0,
        aim_roll_deg=12.0,
        dock=Bobbing(1, 0.1, 0.2, 0.3, 4.0, 5.0, 6.0, 3.0),
        vehicle=Bobbing(2, 0.3, 0.2, 0.1, 6.0, 5.0, 4.0, 2.0),
    )
    time_s = 3.7
    ahead = np.array([np.cos(np.radians(130)), np.sin(np.radians(130)), 0])
    right, down = np.array([-ahead[1], ahead[0], 0]), np.array([0, 0, 1.0])
    rest = homogeneous(np.column_stack([right, down, ahead]), 2.0 * down)
    place = (4.0 - 0.37 * 3.0) * -ahead + 0.7 * right - 0.4 * down
    sight = -place / np.linalg.norm(place)
    across = np.cross(down, sight) / np.linalg.norm(np.cross(down, sight))
    camera = homogeneous(
        np.column_stack([across, np.cross(sight, across), sight]), place + 2.0 * down
    )
    aim = homogeneous(about("y", 5) @ about("x", -3) @ about("z", 12), np.zeros(3))
    bob = {key: homogeneous(b.at(time_s).R, b.at(time_s).t)
           for key, b in (("dock", motion.dock), ("vehicle", motion.vehicle))}  # fmt: skip
    wanted = np.linalg.inv(camera @ aim @ bob["vehicle"]) @ rest @ bob["dock"]
    found = motion.T_camera_dock(time_s)
    np.testing.assert_allclose(homogeneous(found.R, found.t), wanted, atol=1e-12)
    again = matrix_from_quaternion(quaternion_from_matrix(found.R))
    np.testing.assert_allclose(again, found.R, atol=1e-12)


def test_offsets_leave_the_dock_in_the_middle_and_aim_moves_it() -> None:
    aside = hold(3.0, offset_right_m=1.0, offset_down_m=0.5).T_camera_dock(0.0)
    np.testing.assert_allclose(aside.t, [0, 0, np.sqrt(9 + 1 + 0.25)], atol=1e-12)
    assert aside.R[0, 2] > 0  # seen from its right, the dock's far side lies to the right
    for key, axis, sign in (("aim_yaw_deg", 0, -1), ("aim_pitch_deg", 1, 1)):
        t = hold(3.0, **{key: 10.0}).T_camera_dock(0.0).t
        assert t[axis] == pytest.approx(sign * 3 * np.sin(np.radians(10)))
    right = hold(3.0, aim_roll_deg=10.0).T_camera_dock(0.0).R[:, 0]
    assert right[1] < -0.1  # a camera whose right side is low sees the dock's right side high


@pytest.mark.parametrize("roll", [90.0, 180.0, -30.0])
def test_a_mounted_camera_sees_all_turned_about_its_line_of_sight(roll: float) -> None:
    bobbing = Bobbing(3, 0.1, 0.2, 0.3, 4.0, 5.0, 6.0, 3.0)
    upright, mounted = (hold(3.0, vehicle=bobbing, camera_roll_deg=deg) for deg in (0.0, roll))
    for time_s in (0.0, 1.7):
        wanted = about("z", -roll) @ upright.T_camera_dock(time_s).R
        np.testing.assert_allclose(mounted.T_camera_dock(time_s).R, wanted, atol=1e-12)
        places = [m.T_world_camera(time_s).t for m in (upright, mounted)]
        np.testing.assert_array_equal(*places)


def test_an_approach_is_steady_and_then_holds() -> None:
    course = Course(5.0, 1.0, 8.0)
    times = np.array([-1.0, 0.0, 2.0, 4.0, 8.0, 99.0])
    found = [course.distance_m(time) for time in times]
    assert found == pytest.approx(np.interp(times, [0, 8], [5, 1]))


def test_bobbing_has_the_amplitudes_that_are_asked_for(record_property) -> None:
    amplitudes = {"surge_m": 0.1, "sway_m": 0.2, "heave_m": 0.3,
                  "roll_deg": 3.0, "pitch_deg": 2.0, "yaw_deg": 1.0}  # fmt: skip
    bobbing = Bobbing(seed=5, **amplitudes)
    poses = [bobbing.at(time) for time in np.arange(0, 400, 0.5)]
    t = np.array([pose.t for pose in poses])[:, [2, 0, 1]]
    rotations = np.array([cv2.Rodrigues(pose.R)[0].ravel() for pose in poses])[:, [2, 0, 1]]
    rms = np.concatenate([t.std(axis=0), np.degrees(rotations).std(axis=0)]) * np.sqrt(2)
    record_property(
        "figure", f"amplitudes over wanted: {np.round(rms / list(amplitudes.values()), 2)}"
    )
    np.testing.assert_allclose(rms, list(amplitudes.values()), rtol=0.15)
    still = Bobbing(seed=5).at(12.0)
    np.testing.assert_array_equal(still.R, np.eye(3))
    assert not still.t.any()


def test_seeds_make_the_motion_and_nothing_else_does() -> None:
    one, same, other = (Bobbing(seed, heave_m=1.0) for seed in (1, 1, 2))
    assert one.at(3.0).t[1] == same.at(3.0).t[1] != other.at(3.0).t[1]


def test_transforms_compose_and_invert_as_matrices_do() -> None:
    a = Transform(turned(10, 20, 30), np.array([1.0, 2.0, 3.0]))
    b = Transform(turned(-40, 5, 8), np.array([-3.0, 0.5, 1.0]))
    product = homogeneous(a.R, a.t) @ np.linalg.inv(homogeneous(b.R, b.t))
    found = a @ b.inverse()
    np.testing.assert_allclose(homogeneous(found.R, found.t), product, atol=1e-12)
    point = np.array([0.3, -0.2, 4.0])
    np.testing.assert_allclose(found.points(point), (product @ [*point, 1])[:3])
