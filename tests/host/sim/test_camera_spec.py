"""Camera files: the shipped ones, a user's copy, and those that are wrong."""

from importlib import resources

import numpy as np
import pytest

from chromadock.errors import ChromadockError
from chromadock.link.rgb565 import HEIGHT, WIDTH
from chromadock.sim.camera_spec import SHIPPED, load_camera
from chromadock.sim.control import CameraSettings, ControlSpec

TEXT = {
    name: (resources.files("chromadock.sim") / "cameras" / f"{name}.toml").read_text()
    for name in SHIPPED
}


@pytest.fixture
def load(tmp_path):
    """Write a camera file and load it."""

    def load_text(text):
        path = tmp_path / "mine.toml"
        path.write_text(text)
        return load_camera(path)

    return load_text


def test_the_vehicle_camera_is_vga_with_f_512_and_a_mild_distortion():
    camera = load_camera("vehicle")
    assert (camera.model.width, camera.model.height) == (640, 480)
    assert (camera.sensor.width, camera.sensor.height) == (640, 480)
    assert camera.model.matrix[0, 0] == camera.model.matrix[1, 1] == 512
    corner = np.array([-319.5 / 512, -239.5 / 512, 1.0])
    moved = np.linalg.norm(camera.model.project(corner)[0])
    assert 1 < moved < 20


def test_the_dock_camera_has_the_size_that_the_dock_works_on():
    camera = load_camera("ov2640")
    assert (camera.model.width, camera.model.height) == (WIDTH, HEIGHT)
    picture = camera.sensor.picture(
        np.full((HEIGHT, WIDTH, 3), 100, np.float32),
        camera.auto_control().settle((100, 100, 100)),
        np.random.default_rng(0),
    )
    assert picture.shape == (HEIGHT, WIDTH, 3)
    assert picture.dtype == np.uint8


def test_the_dock_camera_rolls_and_locks_as_its_firmware_does():
    camera = load_camera("ov2640")
    assert camera.readout_s > 0
    assert (camera.control.exposure, camera.control.white_balance) == ("start", "daylight")
    assert camera.sensor.jpeg_quality is None


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_camera_is_ready_for_daylight_under_water(name):
    camera = load_camera(name)
    settings = camera.auto_control().settle((300, 300, 300))
    shortest, longest = camera.control.exposure_limits_s
    assert shortest < settings.exposure_s < longest
    assert settings.gain == 1
    assert isinstance(settings, CameraSettings)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_copy_of_a_shipped_file_is_the_same_camera(load, name):
    shipped, mine = load_camera(name), load(TEXT[name])
    assert mine.name == "mine"
    assert shipped.name == name
    assert mine.control == shipped.control
    assert np.array_equal(mine.model.matrix, shipped.model.matrix)
    assert np.array_equal(mine.sensor.colour_matrix, shipped.sensor.colour_matrix)


def test_control_may_be_left_to_its_defaults(load):
    text = TEXT["vehicle"]
    assert load(text[: text.index("[control]")]).control == ControlSpec()


def test_an_exposure_may_be_locked_at_numbers(load):
    old = 'exposure = "auto"'
    assert old in TEXT["vehicle"]
    camera = load(TEXT["vehicle"].replace(old, "exposure = [0.004, 2]"))
    settings = camera.auto_control().settle((1e5, 1e5, 1e5))
    assert (settings.exposure_s, settings.gain) == (0.004, 2)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("width = 640", "width = 641", "lens.width is 641: it must be an even number, 16 to 4096"),
        ("width = 640", 'width = "wide"', "lens.width is 'wide': it must be an even number"),
        ("width = 640\n", "", "lens.width is missing"),
        ("focal_px = 512.0", "focal_px = -512.0", "focal_px is -512.0: it must be 10 to 100000 px"),
        ("focal_px = 512.0", "focal_px = true", "lens.focal_px is True: it must be 10 to"),
        ("focal_px = 512.0", 'focal_px = "512"', "lens.focal_px is '512': it must be 10 to"),
        ("focal_px = 512.0", "focal_px = nan", "lens.focal_px is nan: it must be 10 to"),
        ("centre_px = [319.5, 239.5]", "centre_px = [319.5]", "lens.centre_px is [319.5]: it must"),
        ("[-0.08, 0.03, 0.0, 0.0, 0.0]", "[-0.08, 0.03]", "lens.distortion is [-0.08, 0.03]: it"),
        ("f_number = 2.0", "f_number = 2.0\nzoom = 2", "unknown key lens.zoom"),
        ("readout_s = 0.0", "readout_s = 30", "readout_s is 30: it must be 0 to 1 s"),
        ("bits = 10", "bits = 10.5", "sensor.bits is 10.5: it must be 8 to 16 bits"),
        ("read_noise_e = 5.0", "read_noise_e = -5", "it must be 0 to 1000 electrons"),
        ("[526.0, 96.0", "[0.526, 96.0", "green 1, number 1 is 0.526: it must be 400 to 700 nm"),
        ("[526.0, 96.0", "[926.0, 96.0", "green 1, number 1 is 926.0: it must be 400 to 700 nm"),
        ("[[526.0, 96.0, 1.0]]", "[[526.0, 96.0]]", "response.green 1, number 3 is missing"),
        ("[[526.0, 96.0, 1.0]]", "[]", "response.green is []: it must be a list of at least 1"),
        ("[[526.0, 96.0, 1.0]]", "526", "response.green is 526: it must be a list"),
        ("colour_correction = 0.6", "colour_correction = 60", "it must be 0 to 1"),
        ("jpeg_quality = 90", "jpeg_quality = 0", "picture.jpeg_quality is 0: it must be 1 to 100"),
        ('"auto"\n# "auto" (grey', '"fast"\n# "auto" (grey', "control.exposure is 'fast': it must"),
        ('"daylight"\nexp', '"sunny"\nexp', "control.white_balance is 'sunny': it must be 'auto'"),
        ("gain_limits = [1.0, 16.0]", "gain_limits = [16.0, 1.0]", "control: gain_limits is [16"),
        ("gain_limits = [1.0, 16.0]", "gain = 3", "unknown key control.gain"),
        (
            "gain_limits = [1.0, 16.0]",
            "tint = [1, 0, 1]",
            "tint, number 2 is 0: it must be 0.25 to",
        ),
        ("[picture]", "[pictures]", "picture is missing"),
        ("[lens]", "[lens", "not valid TOML"),
    ],
)
def test_a_wrong_camera_file_is_refused_in_one_line(load, old, new, says):
    text = TEXT["vehicle"]
    assert old in text
    with pytest.raises(ChromadockError) as raised:
        load(text.replace(old, new, 1))
    line = str(raised.value)
    assert "mine.toml: " in line
    assert says in line
    assert "\n" not in line


def test_an_unknown_camera_names_those_that_are_shipped():
    with pytest.raises(ChromadockError, match=r"eyes: cannot be read .*one of vehicle, ov2640"):
        load_camera("eyes")


def test_a_picture_given_as_camera_file_is_refused(tmp_path):
    path = tmp_path / "camera.toml"
    path.write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe")
    with pytest.raises(ChromadockError, match="not a text file"):
        load_camera(path)
