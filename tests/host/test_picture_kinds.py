"""Pictures of unusual kinds: read rightly, or told what they look like and what to do."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image, TiffImagePlugin, features
from simulation import chromadock
from video_clips import SIZE, write_clip

from chromadock.errors import ChromadockError
from chromadock.sources import open_source

SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "data"
BGR = (200, 160, 40)
BAYER = {"RGGB": (2, 1, 1, 0), "BGGR": (0, 1, 1, 2), "GRBG": (1, 2, 0, 1), "GBRG": (1, 0, 2, 1)}


def water(height=96, width=128):
    """HxWx3 uint8 BGR, brighter to the right, with a grain."""
    grain = np.random.default_rng(3).normal(0, 4, (height, width, 3))
    return np.clip(np.array(BGR) * np.linspace(0.6, 1, width)[:, None] + grain, 0, 255).astype(
        np.uint8
    )


def mosaic(picture, order="RGGB"):
    """HxW: of each pixel the one colour that a sensor sees there."""
    out = picture[:, :, 0].copy()
    for place, channel in enumerate(BAYER[order]):
        y, x = divmod(place, 2)
        out[y::2, x::2] = picture[y::2, x::2, channel]
    return out


def read(path):
    """Frames, faults, notes, and the source after its end."""
    faults, notes = [], []
    with open_source(str(path), on_fault=faults.append, on_note=notes.append) as source:
        frames = list(source)
    return frames, faults, notes, source


def refused(path, *says):
    with pytest.raises(ChromadockError) as raised:
        read(path)
    line = str(raised.value)
    assert line.startswith(f"{path}")
    assert "\n" not in line
    for words in says:
        assert words in line


# --- mosaics ---


@pytest.mark.parametrize("order", BAYER)
def test_the_raw_mosaic_of_a_sensor_is_told(tmp_path, order):
    raw = mosaic(water(), order)
    Image.fromarray(raw).save(tmp_path / "a.png")
    Image.fromarray(raw).save(tmp_path / "a.jpg", quality=90)
    Image.fromarray(raw.astype(np.uint16) << 4).save(tmp_path / "twelve.png")
    cv2.imwrite(str(tmp_path / "three.png"), cv2.cvtColor(raw, cv2.COLOR_GRAY2BGR))
    for name in ("a.png", "a.jpg", "twelve.png", "three.png"):
        refused(tmp_path / name, "looks like the raw Bayer mosaic", ": demosaic it first")


def test_in_a_folder_mosaics_are_skipped(tmp_path):
    Image.fromarray(mosaic(water())).save(tmp_path / "1.png")
    Image.fromarray(water()).save(tmp_path / "2.png")
    frames, (fault,), _, source = read(tmp_path)
    assert [f.name for f in frames] == ["2.png"]
    assert source.errors == 1
    assert "Bayer" in fault
    assert fault.endswith("(skipped)")


def test_a_video_of_mosaics_is_told(tmp_path):
    big = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    big[:] = BGR
    raw = cv2.cvtColor(mosaic(big), cv2.COLOR_GRAY2BGR)
    refused(
        write_clip(tmp_path / "clip.avi", "ffv1", range(3), shown=lambda _number: raw),
        "looks like the raw Bayer mosaic",
    )


def test_grey_pictures_interlaced_ones_and_textures_are_no_mosaics(tmp_path):
    grey = cv2.cvtColor(water(), cv2.COLOR_BGR2GRAY)
    interlaced = grey.copy()
    interlaced[::2] = np.minimum(grey[::2], 225) + 30
    texture = np.random.default_rng(1).integers(0, 255, grey.shape, dtype=np.uint8)
    ramp = np.add.outer(np.arange(120), np.arange(160)).astype(np.uint8)
    for name, image in (("a", grey), ("b", interlaced), ("c", texture), ("d", ramp)):
        Image.fromarray(image).save(tmp_path / f"{name}.png")
    frames, faults, _, _ = read(tmp_path)
    assert faults == []
    assert len(frames) == 4


def test_photographs_are_no_mosaics_until_they_are_made_some(tmp_path):
    photographs = sorted((SHARED / "transdec").rglob("*.jpg"))
    if not photographs:
        pytest.skip(f"the photographs are missing: {SHARED / 'transdec'}")
    for index, path in enumerate(photographs):
        picture = cv2.imread(str(path))
        picture = picture[: picture.shape[0] // 2 * 2, : picture.shape[1] // 2 * 2]
        cv2.imwrite(str(tmp_path / f"{index} grey.bmp"), cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY))
        cv2.imwrite(str(tmp_path / f"{index} raw.bmp"), mosaic(picture, "GRBG"))
    frames, faults, _, _ = read(tmp_path)
    assert {f.name.split()[1] for f in frames} == {"grey.bmp"}
    assert len(frames) == len(faults) == len(photographs)


# --- 12 bits in 16 ---


def deep(value=BGR, shift=4):
    picture = np.zeros((8, 10, 3), np.uint16)
    picture[:] = np.array(value, np.uint16) << shift
    return picture


@pytest.mark.parametrize("suffix", ["png", "tif"])
def test_12_bits_in_16_are_taken_for_12_and_told_once(tmp_path, suffix):
    for name in ("1", "2"):
        cv2.imwrite(str(tmp_path / f"{name}.{suffix}"), deep())
    frames, faults, (note,), source = read(tmp_path)
    assert [f.image[0, 0].tolist() for f in frames] == [list(BGR)] * 2
    assert (faults, source.errors) == ([], 0)
    assert note.startswith(f"{tmp_path / '1'}.{suffix}: 16 bits a channel, but none above 3200: ")


def test_12_bits_of_grey_in_16_are_taken_for_12(tmp_path):
    Image.fromarray(deep()[:, :, 0]).save(tmp_path / "a.png")
    (frame,), _, (note,), _ = read(tmp_path / "a.png")
    assert (frame.image == BGR[0]).all()
    assert "taken for 12 bits in 16" in note


def test_once_16_bits_were_seen_all_later_pictures_have_16(tmp_path):
    for name, shift in (("1", 8), ("2", 4), ("3", 8)):
        cv2.imwrite(str(tmp_path / f"{name}.png"), deep(shift=shift))
    frames, _, notes, _ = read(tmp_path)
    assert [f.image[0, 0, 0] for f in frames] == [BGR[0], BGR[0] >> 4, BGR[0]]
    assert notes == []


def test_a_film_of_12_bits_in_16_is_taken_for_12(tmp_path):
    clip = write_clip(tmp_path / "clip.mkv", "ffv1", range(3), pixels="gray16le", shift=4)
    frames, faults, notes, _ = read(clip)
    assert faults == []
    assert len(notes) == 1
    assert frames[2].image[32, 48, 0] == pytest.approx(54, abs=1)


def test_deep_colours_are_turned_as_their_exif_says(tmp_path):
    picture = deep(shift=8)
    picture[:4, :5] = 0xFFFF
    for value in range(1, 9):
        exif = Image.Exif()
        exif[0x0112] = value
        shallow = tmp_path / "shallow.png"
        Image.fromarray((picture >> 8).astype(np.uint8)[:, :, ::-1]).save(shallow, exif=exif)
        data = shallow.read_bytes()
        chunk = data[data.index(b"eXIf") - 4 :]
        chunk = chunk[: 12 + int.from_bytes(chunk[:4], "big")]
        plain = cv2.imencode(".png", picture)[1].tobytes()
        (tmp_path / "deep.png").write_bytes(plain[:33] + chunk + plain[33:])
        (wanted,), _, _, _ = read(shallow)
        (frame,), _, _, _ = read(tmp_path / "deep.png")
        assert np.array_equal(frame.image, wanted.image), value


# --- pages ---


def stack(path, pages, **options):
    first, *rest = [Image.fromarray(page) for page in pages]
    first.save(path, save_all=True, append_images=rest, **options)
    return path


def test_each_page_of_a_tiff_is_a_frame(tmp_path):
    pages = [np.full((12, 16, 3), 60 * n, np.uint8) for n in range(4)]
    path = stack(tmp_path / "b.tif", pages)
    Image.fromarray(pages[1]).save(tmp_path / "c.png")
    with open_source(str(path), fps=10) as source:
        assert source.count == 4
        frames = list(source)
    assert [f.image[0, 0, 0] for f in frames] == [0, 60, 120, 180]
    assert [f.time_s for f in frames] == pytest.approx([0, 0.1, 0.2, 0.3])
    assert {f.name for f in frames} == {"b.tif"}
    frames, _, _, _ = read(tmp_path)
    assert [(f.name, f.index) for f in frames] == [
        ("b.tif", 0), ("b.tif", 1), ("b.tif", 2), ("b.tif", 3), ("c.png", 4),
    ]  # fmt: skip


def test_pages_of_16_bits_keep_their_own_pixels(tmp_path):
    cv2.imwritemulti(str(tmp_path / "a.tif"), [deep(shift=8), deep((10, 20, 30), 8)])
    frames, _, _, _ = read(tmp_path / "a.tif")
    assert [f.image[0, 0].tolist() for f in frames] == [list(BGR), [10, 20, 30]]


def test_smaller_copies_in_a_tiff_are_no_frames(tmp_path):
    picture, small = Image.fromarray(water()), Image.fromarray(water()[::2, ::2])
    small.encoderinfo = {"tiffinfo": {254: 1}}
    picture.save(tmp_path / "a.tif", save_all=True, append_images=[small])
    frames, _, _, _ = read(tmp_path / "a.tif")
    assert [f.image.shape for f in frames] == [(96, 128, 3)]


def test_a_page_that_is_cut_is_told_and_the_ones_before_are_used(tmp_path):
    noise = np.random.default_rng(0).integers(0, 255, (3, 48, 64, 3), dtype=np.uint8)
    path = stack(tmp_path / "a.tif", noise)
    path.write_bytes(path.read_bytes()[:-5000])
    frames, faults, _, source = read(path)
    assert 1 <= len(frames) <= 2
    assert source.errors == len(faults) >= 1
    assert ", page " in faults[0]


def test_the_second_picture_in_a_jpeg_is_no_frame(tmp_path):
    first, second = Image.fromarray(water()), Image.fromarray(water()[:48, :64])
    first.save(tmp_path / "a.jpg", format="MPO", save_all=True, append_images=[second])
    frames, _, _, _ = read(tmp_path / "a.jpg")
    assert len(frames) == 1


# --- kinds that are not read ---


def ftyp(brand):
    return b"\0\0\0\x18ftyp" + brand + b"\0\0\0\0mif1heic\0\0\0\x08mdat" + bytes(64)


@pytest.mark.parametrize("name", ["a.jpg", "a.heic", "a"])
@pytest.mark.parametrize("brand", [b"heic", b"heix", b"mif1"])
def test_a_heic_is_told_whatever_its_name(tmp_path, name, brand):
    (tmp_path / name).write_bytes(ftyp(brand))
    refused(tmp_path / name, "a HEIC picture", "convert it to JPEG or PNG")


@pytest.mark.parametrize(
    ("name", "head", "kind"),
    [
        ("a.CR2", b"II*\0\x10\0\0\0CR\x02\0", "CR2"),
        ("a.tif", b"II*\0\x10\0\0\0CR\x02\0", "CR2"),
        ("a.cr3", b"\0\0\0\x18ftypcrx \0\0\0\x01", "CR3"),
        ("a.NEF", b"MM\0*\0\0\0\x08", "NEF"),
        ("a.raf", b"FUJIFILMCCD-RAW 0201", "RAF"),
        ("a.jpg", b"IIRO\x08\0\0\0", "ORF"),
        ("a.rw2", b"IIU\0\x18\0\0\0", "RW2"),
    ],
)
def test_a_cameras_raw_file_is_told(tmp_path, name, head, kind):
    (tmp_path / name).write_bytes(head + bytes(64))
    refused(tmp_path / name, f"a camera's raw file ({kind}): develop it")


@pytest.mark.parametrize(
    "tags",
    [{50706: b"\x01\x04\0\0"}, {254: 1, 330: 8}],
    ids=["DNG", "preview of more"],
)
def test_the_preview_in_a_raw_file_is_not_taken_for_the_picture(tmp_path, tags):
    info = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, value in tags.items():
        info.tagtype[tag] = 1 if isinstance(value, bytes) else 4
        info[tag] = value
    Image.fromarray(water()).save(tmp_path / "a.tif", tiffinfo=info)
    refused(tmp_path / "a.tif", "a camera's raw file", "develop it")


def test_a_folder_of_kinds_that_are_not_read_names_the_kind(tmp_path):
    (tmp_path / "IMG_1.HEIC").write_bytes(ftyp(b"heic"))
    (tmp_path / "notes.txt").write_text("of the phone")
    with pytest.raises(ChromadockError, match=r"IMG_1\.HEIC: a HEIC picture"):
        read(tmp_path)
    with pytest.raises(ChromadockError, match=r"IMG_1\.HEIC: a HEIC picture"):
        read(tmp_path / "*.HEIC")


@pytest.mark.skipif(not features.check("avif"), reason="this Pillow has no AVIF")
@pytest.mark.parametrize("name", ["a.avif", "a.jpg"])
def test_an_avif_is_read(tmp_path, name):
    Image.fromarray(water()[:, :, ::-1]).save(tmp_path / name, format="AVIF", quality=95)
    (frame,), _, _, _ = read(tmp_path / name)
    assert np.abs(frame.image.astype(int) - water()).mean() < 8


@pytest.mark.parametrize("shape", [(8, 10), (8, 10, 3)])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_floating_point_is_told_in_any_shape(tmp_path, shape, kind):
    cv2.imwrite(str(tmp_path / "a.tif"), np.full(shape, 0.5, kind))
    refused(tmp_path / "a.tif", "floating point pixels are not supported: save it with 8 or 16")


def test_a_cmyk_jpeg_has_its_colours(tmp_path):
    picture = Image.new("RGB", (16, 16), BGR[::-1])
    picture.convert("CMYK").save(tmp_path / "a.jpg", quality=95)
    (frame,), _, _, _ = read(tmp_path / "a.jpg")
    assert np.abs(frame.image.astype(int) - BGR).max() < 6


def test_colours_that_are_not_of_a_screen_are_told(tmp_path):
    Image.new("LAB", (16, 16)).save(tmp_path / "a.tif")
    refused(tmp_path / "a.tif", "colours of the kind LAB: save it as RGB")


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("c_bayer_rggb8.png", "looks like the raw Bayer mosaic"),
        ("e_heic_named.jpg", "a HEIC picture"),
        ("d_stack.tif", None),
    ],
)
def test_the_reported_pictures_are_told_or_read(name, says):
    path = SHARED / "reports" / "pictures" / name
    if not path.is_file():
        pytest.skip(f"the reported pictures are missing: {path.parent}")
    if says is None:
        assert len(read(path)[0]) == 3
    else:
        refused(path, says)


# --- the command line ---


def test_a_pattern_that_the_shell_took_apart_is_told(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("1.png", "2.png", "3.png"):
        Image.fromarray(water()).save(name)
    done = chromadock(capsys, "detect", "1.png", "2.png", "3.png", "--json")
    assert done.status == 2
    assert done.out == ""
    (line,) = done.err.splitlines()
    assert line.startswith("chromadock: error: 3 sources are given: give one; put a pattern into")


def test_what_was_assumed_is_a_warning_and_no_fault(tmp_path, capsys):
    cv2.imwrite(str(tmp_path / "a.png"), deep())
    done = chromadock(capsys, "detect", tmp_path / "a.png", "--json")
    assert done.status == 0
    assert done.err.startswith(f"chromadock: warning: {tmp_path / 'a.png'}: 16 bits a channel")
