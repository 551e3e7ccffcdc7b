"""open_source: every kind of source gives the same frames, and broken ones say so."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from chromadock.errors import ChromadockError
from chromadock.sources import open_source
from chromadock.sources.container import missing_bytes

RGB = (10, 120, 230)


def picture(width=8, height=6, rgb=RGB):
    return Image.new("RGB", (width, height), rgb)


def save_video(path, frames=12, size=(64, 48), fps=25.0, codec=None):
    codec = codec or {".avi": "MJPG", ".mkv": "MJPG", ".mp4": "mp4v"}[path.suffix]
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*codec), fps, size)
    assert writer.isOpened()
    noise = np.random.default_rng(7)
    for index in range(frames):
        image = noise.integers(0, 60, (size[1], size[0], 3), dtype=np.uint8)
        image[:, : 5 * index + 1] = 200
        writer.write(image)
    writer.release()
    return path


def frames_of(text, **options):
    with open_source(str(text), **options) as source:
        return list(source)


# --- pictures ---


def test_a_picture_is_one_bgr_frame(tmp_path):
    picture().save(tmp_path / "a.png")
    (frame,) = frames_of(tmp_path / "a.png")
    assert frame.image.shape == (6, 8, 3)
    assert frame.image.dtype == np.uint8
    assert frame.image[0, 0].tolist() == [230, 120, 10]
    assert (frame.name, frame.index, frame.time_s) == ("a.png", 0, 0.0)


def test_a_folder_is_sorted_as_people_count(tmp_path):
    for name in ("10.png", "9.png", "1.png", "a2.jpg", "a10.jpg"):
        picture().save(tmp_path / name)
    (tmp_path / "1.xml").write_text("<a/>")
    (tmp_path / "._1.png").write_bytes(b"leftover")
    with open_source(str(tmp_path), fps=10) as source:
        assert source.count == 5
        frames = list(source)
    assert [f.name for f in frames] == ["1.png", "9.png", "10.png", "a2.jpg", "a10.jpg"]
    assert [f.index for f in frames] == [0, 1, 2, 3, 4]
    assert [f.time_s for f in frames] == pytest.approx([0, 0.1, 0.2, 0.3, 0.4])


def test_pictures_come_thirty_a_second_unless_told(tmp_path):
    for name in ("1.png", "2.png"):
        picture().save(tmp_path / name)
    assert frames_of(tmp_path)[1].time_s == pytest.approx(1 / 30)


def test_a_glob_names_pictures_by_what_tells_them_apart(tmp_path):
    for place in ("a/1.png", "a/2.png", "b/1.png"):
        (tmp_path / place).parent.mkdir(exist_ok=True)
        picture().save(tmp_path / place)
    assert [f.name for f in frames_of(tmp_path / "*/1.png")] == ["a/1.png", "b/1.png"]
    assert [f.name for f in frames_of(tmp_path / "a/*.png")] == ["1.png", "2.png"]


def test_a_file_whose_name_looks_like_a_pattern_or_pipeline_is_a_file(tmp_path):
    for name in ("wow!.png", "shot[1].png"):
        picture().save(tmp_path / name)
        assert frames_of(tmp_path / name)[0].name == name


def test_a_picture_without_suffix_is_recognised(tmp_path):
    picture().save(tmp_path / "snapshot", format="PNG")
    assert frames_of(tmp_path / "snapshot")[0].image.shape == (6, 8, 3)


@pytest.mark.parametrize(
    ("make", "bgr"),
    [
        (lambda: picture().convert("L"), [100, 100, 100]),
        (lambda: picture().convert("1", dither=Image.Dither.NONE), [0, 0, 0]),
        (lambda: Image.new("RGBA", (8, 6), (*RGB, 0)), [230, 120, 10]),
        (lambda: Image.new("LA", (8, 6), (90, 3)), [90, 90, 90]),
        (lambda: picture().quantize(4), [230, 120, 10]),
        (lambda: Image.fromarray(np.full((6, 8), 0x12FF, np.uint16)), [0x12, 0x12, 0x12]),
    ],
    ids=["grey", "bilevel", "alpha", "grey with alpha", "palette", "16 bit grey"],
)
def test_every_pixel_format_becomes_three_channels_of_8_bits(tmp_path, make, bgr):
    make().save(tmp_path / "a.png")
    (frame,) = frames_of(tmp_path / "a.png")
    assert frame.image.dtype == np.uint8
    assert frame.image.shape == (6, 8, 3)
    assert (frame.image == bgr).all()


def test_of_16_bit_colour_the_upper_8_bits_are_taken(tmp_path):
    deep = np.zeros((6, 8, 3), np.uint16)
    deep[:] = (0x01FF, 0x80FF, 0xFEFF)
    cv2.imwrite(str(tmp_path / "a.png"), deep)
    cv2.imwrite(str(tmp_path / "b.tif"), deep)
    for frame in frames_of(tmp_path):
        assert (frame.image == (0x01, 0x80, 0xFE)).all(), frame.name


def test_a_palette_with_transparency_keeps_its_colour(tmp_path):
    image = picture().quantize(4)
    image.save(tmp_path / "a.png", transparency=image.getpixel((0, 0)))
    assert (frames_of(tmp_path / "a.png")[0].image == (230, 120, 10)).all()


def test_a_picture_is_turned_as_its_exif_says(tmp_path):
    image = picture()
    image.putpixel((0, 0), (255, 255, 255))
    exif = Image.Exif()
    exif[0x0112] = 6  # the top of the picture is on the right
    image.save(tmp_path / "a.png", exif=exif)
    (frame,) = frames_of(tmp_path / "a.png")
    assert frame.image.shape == (8, 6, 3)
    assert frame.image[0, 5].tolist() == [255, 255, 255]


def test_floating_point_pictures_are_refused(tmp_path):
    Image.fromarray(np.ones((6, 8), np.float32)).save(tmp_path / "a.tif")
    with pytest.raises(ChromadockError, match="floating point"):
        frames_of(tmp_path / "a.tif")


@pytest.mark.parametrize("suffix", ["jpg", "png"])
@pytest.mark.parametrize("share", [0.05, 0.5, 0.95])
def test_a_truncated_picture_is_reported_skipped_and_counted(tmp_path, suffix, share):
    noise = np.random.default_rng(1).integers(0, 255, (60, 80, 3), dtype=np.uint8)
    for name in ("1", "2", "3"):
        Image.fromarray(noise).save(tmp_path / f"{name}.{suffix}")
    broken = tmp_path / f"2.{suffix}"
    whole = broken.read_bytes()
    broken.write_bytes(whole[: int(len(whole) * share)])
    lines = []
    with open_source(str(tmp_path), fps=10, on_fault=lines.append) as source:
        frames = list(source)
        assert source.errors == 1
    assert [f.index for f in frames] == [0, 2]
    assert frames[1].time_s == pytest.approx(0.2)
    (line,) = lines
    assert str(broken) in line
    assert "\n" not in line
    assert "copy it again" in line


@pytest.mark.parametrize("content", [b"", b"words", b"\x89PNG\r\n\x1a\n"])
def test_a_single_corrupt_picture_is_refused(tmp_path, content):
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(ChromadockError, match=r"a\.png: ") as raised:
        frames_of(tmp_path / "a.png")
    assert "\n" not in str(raised.value)


# --- videos ---


@pytest.mark.parametrize("suffix", [".mp4", ".avi", ".mkv"])
def test_a_video_gives_its_frames_at_their_times(tmp_path, suffix):
    path = save_video(tmp_path / f"clip{suffix}")
    with open_source(str(path)) as source:
        assert source.count == 12
        assert source.fps == pytest.approx(25)
        frames = list(source)
    assert [f.index for f in frames] == list(range(12))
    assert {f.name for f in frames} == {path.name}
    assert [f.time_s for f in frames] == pytest.approx([i / 25 for i in range(12)], abs=1e-3)
    assert frames[6].image.shape == (48, 64, 3)
    assert frames[6].image[:, :28].mean() > 150
    assert frames[6].image[:, 34:].mean() < 80


def test_a_stream_container_of_unknown_length_is_not_called_cut_short(tmp_path):
    path = save_video(tmp_path / "clip.mkv")
    data = path.read_bytes()
    segment = data.index(b"\x18\x53\x80\x67") + 4
    assert data[segment] == 0x01  # eight bytes of size
    path.write_bytes(data[:segment] + b"\x01" + b"\xff" * 7 + data[segment + 8 :])
    assert missing_bytes(path) == 0
    assert len(frames_of(path)) == 12


@pytest.mark.parametrize(
    ("head", "missing"),
    [
        (b"\x00\x00\x00\x10ftypisom" + bytes(4), 0),
        (b"\x00\x00\x00\x20ftypisom" + bytes(4), 16),
        (b"\x00\x00\x00\x01mdat" + (40).to_bytes(8, "big"), 24),
        (b"\x00\x00\x00\x00mdat" + bytes(8), 0),
        (b"RIFF\x00\x00\x00\x00AVI " + bytes(4), 0),
        (b"RIFF\x18\x00\x00\x00AVI " + bytes(4), 16),
        (b"\x00\x00\x01\xba" + bytes(12), 0),
        (b"", 0),
    ],
)
def test_containers_tell_what_is_missing(tmp_path, head, missing):
    (tmp_path / "clip").write_bytes(head)
    assert missing_bytes(tmp_path / "clip") == missing


# --- what is no source ---


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(ChromadockError, match="no such file or folder"):
        open_source(str(tmp_path / "none.mp4"))


def test_an_empty_file_is_refused(tmp_path):
    (tmp_path / "clip.mp4").touch()
    with pytest.raises(ChromadockError, match="empty"):
        open_source(str(tmp_path / "clip.mp4"))


def test_a_text_file_is_no_video(tmp_path):
    (tmp_path / "notes.txt").write_text("das Wasser war gr\u00fcn\n" * 300)
    with pytest.raises(ChromadockError, match="cannot be read as a video or picture"):
        open_source(str(tmp_path / "notes.txt"))


def test_a_folder_without_pictures_is_refused(tmp_path):
    (tmp_path / "notes.txt").write_text("nothing")
    with pytest.raises(ChromadockError, match="no pictures in this folder"):
        open_source(str(tmp_path))


def test_a_glob_that_matches_nothing_is_refused(tmp_path):
    with pytest.raises(ChromadockError, match="no picture matches"):
        open_source(str(tmp_path / "*.png"))


@pytest.mark.parametrize("what", ["a.png", "."])
def test_what_may_not_be_read_is_refused(tmp_path, monkeypatch, what):
    def denied(*_arguments):
        raise PermissionError(13, "Permission denied")

    picture().save(tmp_path / "a.png")
    # Not by its mode: root, who runs tests in containers, may read everything.
    monkeypatch.setattr(Path, "open", denied)
    monkeypatch.setattr(Path, "iterdir", denied)
    with pytest.raises(ChromadockError, match=r"\(Permission denied\): allow reading it"):
        open_source(str(tmp_path / what))


@pytest.mark.parametrize("text", ["97", "/dev/null"])
def test_a_camera_that_does_not_open_is_refused(text):
    with pytest.raises(ChromadockError, match="does not open: check"):
        open_source(text)


def test_a_pipeline_that_does_not_run_is_refused():
    with pytest.raises(ChromadockError, match=r"GStreamer|gst-launch"):
        open_source("nosuchelement ! appsink")


def test_a_url_that_does_not_answer_is_refused_without_its_password():
    with pytest.raises(ChromadockError, match="does not open") as raised:
        open_source("rtsp://me:secret@127.0.0.1:9/stream")
    assert "127.0.0.1:9" in str(raised.value)
    assert "secret" not in str(raised.value)


@pytest.mark.parametrize("fps", [0, -1, float("nan"), float("inf")])
def test_frames_a_second_must_be_a_positive_number(tmp_path, fps):
    picture().save(tmp_path / "a.png")
    with pytest.raises(ChromadockError, match="--fps is"):
        open_source(str(tmp_path), fps=fps)
