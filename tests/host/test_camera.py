"""CameraModel: pixels to rays and back, and camera files that are wrong."""

import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.errors import ChromadockError

GOOD = """\
image_width: 640
image_height: 480
camera_name: nose
camera_matrix:
  rows: 3
  cols: 3
  data: [500.0, 0.0, 320.5, 0.0, 501.0, 240.5, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.3, 0.1, 1e-05, -0.0002, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
"""

OPENCV = """\
%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 501., 240., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -3.0e-01, 1.0e-01, 0., 0., 0. ]
"""


@pytest.fixture
def written(tmp_path):
    """Write a camera file and give its path."""

    def write(text, name="cam.yaml"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_a_ros_camera_file_gives_its_numbers(written):
    camera = CameraModel.from_yaml(written(GOOD))
    assert (camera.width, camera.height) == (640, 480)
    assert camera.matrix.tolist() == [[500, 0, 320.5], [0, 501, 240.5], [0, 0, 1]]
    assert camera.matrix.dtype == np.float64
    # YAML 1.1 reads 1e-05 without a point as text; yaml-cpp, so ROS, writes just that.
    assert camera.distortion.tolist() == [-0.3, 0.1, 1e-05, -0.0002, 0.0]


def test_opencvs_own_dialect_is_read_too(written):
    camera = CameraModel.from_yaml(written(OPENCV))
    assert camera.matrix[1, 1] == 501
    assert camera.distortion.tolist() == [-0.3, 0.1, 0, 0, 0]


def test_no_coefficients_mean_no_distortion(written):
    camera = CameraModel.from_yaml(written(GOOD.replace("-0.3, 0.1, 1e-05, -0.0002, 0.0", "")))
    assert camera.undistort([[820.5, 240.5]]).tolist() == [[1.0, 0.0]]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("image_width: 640\n", "", "image_width is missing"),
        ("image_width: 640", "image_width: wide", "image_width is 'wide'"),
        ("image_height: 480", "image_height: 0", "image_height is 0: it must be positive"),
        ("image_height: 480", "image_height: -480", "image_height is -480"),
        ("camera_matrix:", "matrix:", "camera_matrix is missing"),
        ("0.0, 0.0, 1.0]", "0.0, 1.0]", "camera_matrix.data has 8 numbers"),
        ("0.0, 0.0, 1.0]", "0.0, 0.0, 1.0, 0.0]", "camera_matrix.data has 10 numbers"),
        ("[500.0", "[.nan", "camera_matrix.data, number 1 is nan"),
        ("[500.0", "[.inf", "camera_matrix.data, number 1 is inf"),
        ("[500.0", "[five", "camera_matrix.data, number 1 is 'five'"),
        ("[500.0", "[0.0", "singular"),
        ("[500.0", "[-500.0", "fx = -500"),
        ("501.0", "0.0", "singular"),
        ("[500.0, 0.0, 320.5", "[500.0, 3.0, 320.5", "skew"),
        (
            "[500.0, 0.0, 320.5, 0.0, 501.0, 240.5, 0.0, 0.0, 1.0]",
            "[500.0, 0.0, 0.0, 0.0, 501.0, 0.0, 320.5, 240.5, 1.0]",
            "transposed",
        ),
        ("distortion_coefficients:", "d:", "distortion_coefficients is missing"),
        ("[-0.3, 0.1,", "[-0.3, .nan,", "distortion_coefficients.data, number 2 is nan"),
        ("[-0.3, 0.1, 1e-05,", "[", "distortion_coefficients has 2 numbers"),
        ("plumb_bob", "rational_polynomial", "rational_polynomial has 8 or 12 or 14"),
        ("plumb_bob", "equidistant", "has 5 numbers, but equidistant has 4: correct the list"),
        ("plumb_bob\n", "[plumb_bob\n", "not valid YAML (line 9: "),
        (GOOD, "", "no keys"),
        (GOOD, "just words", "no keys"),
        (GOOD, "camera_matrix: 3\n", "image_width is missing"),
        ("camera_matrix:\n  rows: 3\n  cols: 3\n  data:", "camera_matrix:", "rows, cols and data"),
    ],
)
def test_a_wrong_camera_file_is_refused_in_one_line(written, old, new, says):
    assert old in GOOD
    path = written(GOOD.replace(old, new, 1))
    with pytest.raises(ChromadockError) as raised:
        CameraModel.from_yaml(path)
    line = str(raised.value)
    assert line.startswith(f"{path}: ")
    assert says in line
    assert "\n" not in line
    assert len(line) - len(str(path)) < 200


def test_a_missing_camera_file_is_refused(tmp_path):
    with pytest.raises(ChromadockError, match=r"none\.yaml: cannot read .*No such file"):
        CameraModel.from_yaml(tmp_path / "none.yaml")


def test_a_picture_given_as_camera_file_is_refused(tmp_path):
    path = tmp_path / "cam.yaml"
    path.write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe")
    with pytest.raises(ChromadockError, match="not a text file"):
        CameraModel.from_yaml(path)


@pytest.mark.parametrize(
    "distortion",
    [
        [],
        [-0.4, 0.2, 0.001, -0.002],
        [-0.4, 0.2, 0.001, -0.002, -0.05],
        [0.3, -0.2, 0.001, 0.001, 0.1, 0.4, -0.1, 0.05],
    ],
)
def test_undistort_and_project_are_inverse_to_a_thousandth_of_a_pixel(distortion):
    matrix = [[500, 0, 320], [0, 480, 240], [0, 0, 1]]
    camera = CameraModel(640, 480, np.array(matrix, float), np.array(distortion))
    pixels = np.stack(np.meshgrid(np.linspace(0, 639, 9), np.linspace(0, 479, 7)), -1)
    pixels = pixels.reshape(-1, 2)
    rays = camera.undistort(pixels)
    assert rays.shape == (63, 2)
    assert rays.dtype == np.float64
    points = 2.5 * np.column_stack([rays, np.ones(63)])
    assert np.abs(camera.project(points) - pixels).max() < 1e-3


def test_points_that_are_not_in_front_have_no_pixel():
    pixels = CameraModel.nominal(640, 480).project([[0, 0, 2], [0, 0, -2], [1, 1, 0]])
    assert pixels[0].tolist() == [319.5, 239.5]
    assert np.isnan(pixels[1:]).all()


def test_no_points_give_no_points():
    camera = CameraModel.nominal(640, 480)
    assert camera.undistort(np.empty((0, 2))).shape == (0, 2)
    assert camera.project(np.empty((0, 3))).shape == (0, 2)


def test_the_nominal_camera_looks_along_the_middle_of_the_frame():
    camera = CameraModel.nominal(800, 600)
    assert camera.matrix.tolist() == [[640, 0, 399.5], [0, 640, 299.5], [0, 0, 1]]


@pytest.mark.parametrize("shape", [(480, 640), (480, 640, 3)])
def test_frames_of_the_calibrated_size_pass(shape):
    CameraModel.nominal(640, 480).check_size(shape)


@pytest.mark.parametrize("shape", [(640, 480, 3), (240, 320, 3), (1, 1, 3)])
def test_frames_of_another_size_are_refused_with_both_sizes(written, shape):
    camera = CameraModel.from_yaml(written(GOOD))
    with pytest.raises(ChromadockError) as raised:
        camera.check_size(shape)
    line = str(raised.value)
    assert "cam.yaml" in line
    assert "640x480" in line
    assert f"{shape[1]}x{shape[0]}" in line
    assert "calibrate" in line


def test_a_camera_cannot_be_changed_behind_its_back():
    matrix = np.array([[500, 0, 320], [0, 500, 240], [0, 0, 1]], float)
    camera = CameraModel(640, 480, matrix)
    matrix[0, 0] = 1
    assert camera.matrix[0, 0] == 500
    with pytest.raises(ValueError, match="read-only"):
        camera.matrix[0, 0] = 1
