"""Camera files of many tools: read as they are meant, or refused in one line that says why."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.errors import ChromadockError

Write = Callable[..., Path]
REPORTS = Path(__file__).resolve().parents[3] / "shared" / "data" / "reports" / "cameras"

FILE = """\
image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320.5, 0, 501, 240.5, 0, 0, 1]}
distortion_coefficients: {rows: 1, cols: 4, data: [-0.03, 0.01, -0.008, 0.002]}
"""
MESSAGE = """\
header:
  stamp: {sec: 1, nanosec: 2}
  frame_id: cam_optical
height: 480
width: 640
distortion_model: equidistant
d: [-0.03, 0.01, -0.008, 0.002]
k: [500, 0, 320.5, 0, 501, 240.5, 0, 0, 1]
r: [1, 0, 0, 0, 1, 0, 0, 0, 1]
p: [500, 0, 320.5, 0, 0, 501, 240.5, 0, 0, 0, 1, 0]
binning_x: 0
binning_y: 0
roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}
---
"""
KALIBR = """\
cam0:
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [-0.03, 0.01, -0.008, 0.002]
  distortion_model: equi
  intrinsics: [500, 501, 320.5, 240.5]
  resolution: [640, 480]
  rostopic: /cam/image_raw
"""


@pytest.fixture
def written(tmp_path: Path) -> Write:
    """Write a camera file and give its path."""

    def write(text: str, encoding: str = "utf-8", name: str = "cam.yaml") -> Path:
        (tmp_path / name).write_bytes(text.encode(encoding))
        return tmp_path / name

    return write


def refused(path: Path) -> str:
    """The line that a file is refused with."""
    with pytest.raises(ChromadockError) as raised:
        CameraModel.from_yaml(path)
    line = str(raised.value)
    assert line.startswith(str(path)) and "\n" not in line
    assert len(line) - len(str(path)) < 230
    return line


def test_all_layouts_give_the_same_camera(written: Write) -> None:
    texts = [FILE + "distortion_model: equidistant", MESSAGE, KALIBR]
    # ROS 1, several messages one after the other, and the names of an older OpenCV.
    texts += [MESSAGE.replace("\nd:", "\nD:").replace("\nk:", "\nK:"), MESSAGE + MESSAGE]
    texts += [FILE.replace("camera_m", "Camera_M").replace("_w", "_W") + "fisheye_model: 1"]
    for text in texts:
        camera = CameraModel.from_yaml(written(text))
        assert (camera.width, camera.height, camera.lens) == (640, 480, "equidistant")
        assert camera.matrix.tolist() == [[500, 0, 320.5], [0, 501, 240.5], [0, 0, 1]]
        assert camera.distortion.tolist() == [-0.03, 0.01, -0.008, 0.002]


@pytest.mark.parametrize(
    ("line", "lens"),
    [
        ("", "plumb_bob"),
        ("distortion_model: plumb_bob", "plumb_bob"),
        ("distortion_model: equidistant", "equidistant"),
        ("distortion_type: equidistant", "equidistant"),
        ("distortion_type: radtan", "plumb_bob"),
        ("camera_model: fisheye", "equidistant"),
        ("camera_model: Kannala-Brandt", "equidistant"),
        ("camera_model: pinhole", "plumb_bob"),
        ("camera_model: pinhole\ndistortion_model: equi", "equidistant"),
        ("camera_model: Acme 1000\ndistortion_model: plumb_bob", "plumb_bob"),
        ("lens_model: OPENCV_FISHEYE", "equidistant"),
        ("model: fisheye", "equidistant"),
        ("fisheye_model: 1", "equidistant"),
        ("fisheye_model: 0", "plumb_bob"),
        ("fisheye: true", "equidistant"),
        ("lens_mm: 3.6", "plumb_bob"),
    ],
)
def test_a_lens_is_known_under_any_key(written: Write, line: str, lens: str) -> None:
    assert CameraModel.from_yaml(written(FILE + line)).lens == lens


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("distortion_model: fov", "distortion_model fov is not supported: calibrate with plumb"),
        ("distortion_model: thin_prism", "thin_prism is not supported"),
        ("distortion_type: equidistant6", "equidistant6 is not supported"),
        ("camera_model: omni", "camera_model omni is not supported"),
        ("camera_model: ds", "camera_model ds is not supported"),
        ("camera_model: eucm", "camera_model eucm is not supported"),
        ("camera_model: double sphere", "double sphere is not supported"),
        ("camera_type: fisheye624", "fisheye624 is not supported"),
        ("lens_model: Inverse Brown Conrady", "Inverse Brown Conrady is not supported"),
        ("camera_model: Acme 1000", "camera_model Acme 1000 is no lens known here"),
        (
            "camera_model: fisheye\ndistortion_model: plumb_bob",
            "camera_model says equidistant and distortion_model says plumb_bob: keep the one",
        ),
        ("camera_model: fisheye\nfisheye_model: 1\nmodel: radtan", "model says plumb_bob"),
    ],
)
def test_a_lens_of_another_formula_is_refused_by_name(written: Write, line: str, says: str) -> None:
    assert says in refused(written(FILE + line))


@pytest.mark.parametrize(("old", "new"), [("equi", "radtan"), ("pinhole", "omni")])
def test_a_lens_of_kalibrs_is_taken_for_what_it_is(written: Write, old: str, new: str) -> None:
    path = written(KALIBR.replace(old, new))
    if new == "omni":
        assert "camera_model omni is not supported" in refused(path)
    else:
        assert CameraModel.from_yaml(path).lens == "plumb_bob"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (KALIBR + KALIBR.replace("cam0", "cam1"), "cam0 and cam1 are in it: write the one"),
        (KALIBR.replace("[640, 480]", "[640]"), "resolution has 1 numbers: it must have 2"),
        (KALIBR.replace("intrinsics: [500,", "intrinsics: [ho,"), "intrinsics, number 1 is 'ho'"),
        (MESSAGE.replace("k: [500,", "k: ["), "k has 8 numbers: it must have 9"),
        (MESSAGE.replace("d: [-0.03,", "d: ["), "3 numbers, but equidistant has 4"),
        (MESSAGE.replace("height: 480\n", ""), "height is missing"),
        ("<?xml version='1.0'?>\n<opencv_storage>\n", "OpenCV's XML is not read: have it written"),
        ("<?xml version='1.0'?>\n<calibration>\n", "an XML file is not read"),
        ("# oST version 5.0 parameters\n\n\n[image]\n\nwidth\n640\n", "an .ini file is not read"),
        ("Camera.fx: 500.0\nCamera.fy: 500\n", "the settings file of ORB-SLAM is not read"),
        ("%YAML:1.0\n---\nCamera1.fx: 500.0\n", "the settings file of ORB-SLAM is not read"),
        ("model_type: MEI\nmirror_parameters: {xi: 1}\n", "the camera file of VINS (camodocal)"),
        ('{"value0": {"intrinsics": []}}', "the calibration of Basalt is not read"),
    ],
)
def test_another_layout_is_refused_by_name(written: Write, text: str, says: str) -> None:
    assert says in refused(written(text))


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
@pytest.mark.parametrize("head", ["", "%YAML:1.0\n---\n"])
def test_a_byte_order_mark_is_no_part_of_the_text(written: Write, encoding: str, head: str) -> None:
    """Windows' editors write one; its PowerShell writes UTF-16."""
    text = (head + FILE).replace("\n", "\r\n")
    assert CameraModel.from_yaml(written(text, encoding)).matrix[0, 0] == 500


def test_a_packed_file_is_refused_with_what_to_do(tmp_path: Path) -> None:
    """What ROS's calibrator saves is an archive."""
    path = tmp_path / "calibrationdata.tar.gz"
    path.write_bytes(b"\x1f\x8b\x08\x00\xff\xff")
    assert "unpack it and give the .yaml in it" in refused(path)


def windowed(roi: str = "", binning: str = "binning_x: 1") -> str:
    whole, single = "x_offset: 0, y_offset: 0, height: 0, width: 0, ", "binning_x: 0\nbinning_y: 0"
    assert whole in MESSAGE and single in MESSAGE
    return MESSAGE.replace(whole, roi).replace(single, binning)


def test_binned_pixels_and_a_region_are_of_the_full_sensor(written: Write) -> None:
    """A point's pixel is where it is in the full picture, cut out and averaged."""
    full = CameraModel.from_yaml(written(MESSAGE))
    region = "x_offset: 100, y_offset: 60, width: 400, height: 240, "
    camera = CameraModel.from_yaml(written(windowed(region, "binning_x: 4\nbinning_y: 2")))
    assert (camera.width, camera.height) == (100, 120)
    rays = np.array([[0.1, 0.05, 1.0], [-0.2, -0.3, 1.0]])
    # Pixel k of the full picture spans k - 0.5 to k + 0.5, as each does of the other.
    edges = (full.project(rays) + 0.5 - (100, 60)) / (4, 2)
    np.testing.assert_allclose(camera.project(rays), edges - 0.5, atol=1e-9)


def test_a_region_may_lie_beside_the_axis(written: Write) -> None:
    region = "x_offset: 400, y_offset: 300, width: 240, height: 180, "
    camera = CameraModel.from_yaml(written(windowed(region)))
    assert camera.matrix[:2, 2].tolist() == [320.5 - 400, 240.5 - 300]


def test_frames_of_another_size_than_the_window_are_refused_with_the_window(written: Write) -> None:
    camera = CameraModel.from_yaml(written(windowed(binning="binning_x: 2\nbinning_y: 2")))
    with pytest.raises(ChromadockError, match=r"cam.yaml \(binning 2x2 of 640x480\): calibrated "):
        camera.check_size((480, 640, 3))


@pytest.mark.parametrize(
    ("roi", "binning", "says"),
    [
        (
            "x_offset: 320, y_offset: 240, width: 640, height: 480, ",
            "",
            "roi is 640x480 at 320x240",
        ),
        (
            "x_offset: 10, y_offset: 0, ",
            "binning_x: 1",
            "roi begins at 10x0 but has no width and height",
        ),
        ("width: 100, ", "binning_x: 1", "roi is 100x0 at 0x0, not within the 640x480"),
        ("x_offset: -1, ", "binning_x: 1", "roi.x_offset is -1: it must be at least 0"),
        ("", "binning_x: 1000", "binning is 1000x1 of 640x480 pixels"),
        ("", "binning_x: two", "binning_x is 'two'"),
    ],
)
def test_a_window_that_cannot_be_is_refused(
    written: Write, roi: str, binning: str, says: str
) -> None:
    assert says in refused(written(windowed(roi, binning)))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("500, 0, 320.5, 0, 501, 240.5", "3.6, 0, 2.4, 0, 3.6, 1.8", "far too short for 640x480"),
        ("500, 0, 320.5, 0, 501, 240.5", "35, 0, 18, 0, 35, 12", "far too short for 640x480"),
        ("320.5", "960.5", "principal point at (960.5, 240.5), outside the picture of 640x480"),
        ("240.5", "-3", "principal point at (320.5, -3), outside"),
        ("501", "50.1", "correct the one that is wrong"),
        ("-0.03,", "-2.5,", "fold the picture 122 px from its middle"),
    ],
)
def test_numbers_that_no_camera_has_are_refused(
    written: Write, old: str, new: str, says: str
) -> None:
    assert old in FILE
    assert says in refused(written(FILE.replace(old, new)))


def test_what_opencv_writes_is_read(tmp_path: Path) -> None:
    path = str(tmp_path / "cam.yml")
    storage = cv2.FileStorage(path, cv2.FILE_STORAGE_WRITE)
    for key, value in (
        ("image_width", 640),
        ("image_height", 480),
        ("fisheye_model", 1),
        ("camera_matrix", np.array([[300, 0, 320], [0, 300, 240], [0, 0, 1.0]])),
        ("distortion_coefficients", np.array([[0.1], [0.02], [-0.01], [0.001]])),
    ):
        storage.write(key, value)
    storage.release()
    camera = CameraModel.from_yaml(path)
    assert (camera.lens, camera.matrix[0, 0]) == ("equidistant", 300)
    assert camera.distortion.tolist() == [0.1, 0.02, -0.01, 0.001]


@pytest.mark.skipif(not REPORTS.is_dir(), reason="no reports: ../shared/data is missing")
@pytest.mark.parametrize(
    ("name", "lens"),
    [
        ("ah_distortion_type.yaml", "equidistant"),
        ("ai_camera_model_fisheye.yaml", "equidistant"),
        ("b_ros2_topic_echo.yaml", "plumb_bob"),
        ("d_kalibr_camchain.yaml", "plumb_bob"),
        ("h2_bom_opencv.yml", "plumb_bob"),
        ("r_binning.yaml", "plumb_bob"),
        ("r2_roi.yaml", "roi is 640x480 at 320x240, not within the 640x480"),
        ("z2_mm_focal.yaml", "fx = 3.6, fy = 3.6, far too short for 640x480"),
    ],
)
def test_files_of_reports_are_read_or_refused(name: str, lens: str) -> None:
    if " " in lens:
        assert lens in refused(REPORTS / name)
    else:
        assert CameraModel.from_yaml(REPORTS / name).lens == lens
