"""Videos as recorders and interrupted copies leave them: what is there is used, what is not
is told, and neither a number in a header nor a duration is taken for a promise."""

import struct
from pathlib import Path

import av
import numpy as np
import pytest
from video_clips import FPS, cut, number_of, overwrite, packets, patch, write_clip

from chromadock.errors import ChromadockError
from chromadock.sources import open_source

REPORTED = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "reports" / "videos"

FRAGMENTED = {"movflags": "frag_keyframe+empty_moov+default_base_moof"}
B_FRAMES = {"bf": "2", "g": "10"}


def read(path):
    """Frames, the lines told about faults, and the source after its end."""
    lines = []
    with open_source(str(path), on_fault=lines.append) as source:
        frames = list(source)
    return frames, lines, source


def well(path, numbers):
    """All of the numbered pictures at their times, and nothing to tell."""
    frames, lines, source = read(path)
    assert lines == []
    assert (source.errors, source.cut_short) == (0, False)
    assert [number_of(f.image) for f in frames] == list(numbers)
    assert [f.index for f in frames] == list(range(len(frames)))
    assert [f.time_s for f in frames] == pytest.approx(
        [(n - numbers[0]) / FPS for n in numbers], abs=2e-3
    )


# --- a count is no promise ---


@pytest.mark.parametrize("suffix", ["avi", "mkv", "mov"])
def test_sound_may_outlast_the_picture(tmp_path, suffix):
    well(write_clip(tmp_path / f"clip.{suffix}", numbers=range(20), sound_s=3.0), range(20))


def test_frames_that_a_recorder_dropped_leave_a_gap_in_time(tmp_path):
    numbers = [n for n in range(30) if n not in (5, 6, 17)]
    path = write_clip(tmp_path / "clip.avi", numbers=numbers)
    assert path.read_bytes().count(b"00dc\0\0\0\0") >= 3  # chunks of no length
    well(path, numbers)


@pytest.mark.parametrize(("codec", "options"), [("mpeg4", {"g": "10"}), ("libx264", B_FRAMES)])
def test_a_fragmented_mp4_is_read_to_its_end(tmp_path, codec, options):
    clip = write_clip(tmp_path / "clip.mp4", codec, options=options, muxer=FRAGMENTED)
    well(clip, range(30))


def test_what_an_edit_list_trims_is_not_missing(tmp_path):
    clip = write_clip(tmp_path / "clip.mp4", "mpeg4", options={"g": "10"})
    # One entry: duration, and where in the medium it starts.
    data = clip.read_bytes()
    place = data.index(b"elst") + 16
    assert struct.unpack(">i", data[place : place + 4]) == (0,)
    scale = struct.unpack(">I", data[data.index(b"mdhd") + 16 :][:4])[0]
    patch(clip, b"elst", 12, struct.pack(">i", 10 * scale // FPS))
    well(clip, range(10, 30))


@pytest.mark.parametrize("count", [0, 12, 4000])
def test_a_wrong_number_of_frames_in_the_header_is_no_fault(tmp_path, count):
    clip = write_clip(tmp_path / "clip.avi")
    patch(clip, b"avih", 4 + 16, struct.pack("<I", count))
    patch(clip, b"strh", 4 + 32, struct.pack("<I", count))
    well(clip, range(30))


def test_a_size_that_counts_the_whole_file_is_no_fault(tmp_path):
    clip = write_clip(tmp_path / "clip.avi")
    well(patch(clip, b"RIFF", 0, struct.pack("<I", clip.stat().st_size)), range(30))


def test_padding_after_an_mp4_is_no_fault(tmp_path):
    clip = write_clip(tmp_path / "clip.mp4", "mpeg4")
    with clip.open("ab") as file:
        file.write(b"\x7f\xff\xff\xff" * 16)
    well(clip, range(30))


@pytest.mark.parametrize(
    ("name", "frames", "last_s"),
    [
        ("sound_longer.mkv", 60, 59 / 30),
        ("sound_longer.webm", 60, 59 / 30),
        ("dropped.avi", 24, 29 / 30),
        ("dash.mp4", 90, 89 / 30),
    ],
)
def test_videos_that_were_called_damaged_are_whole(name, frames, last_s):
    if not REPORTED.is_dir():
        pytest.skip(f"the reported videos are missing: {REPORTED}")
    got, lines, source = read(REPORTED / name)
    assert lines == []
    assert (len(got), source.errors, source.cut_short) == (frames, 0, False)
    assert got[-1].time_s == pytest.approx(last_s, abs=2e-3)


# --- a bad frame is not the end ---


@pytest.mark.parametrize(
    ("name", "codec", "options"),
    [
        ("clip.avi", "mjpeg", {}),
        ("clip.mkv", "mjpeg", {}),
        ("clip.mp4", "mpeg4", {"g": "1"}),
        ("clip.mp4", "libx264", {"g": "1"}),
    ],
)
@pytest.mark.parametrize("bad", [0, 12, 29])
def test_a_frame_that_cannot_be_decoded_is_told_and_left_out(tmp_path, name, codec, options, bad):
    clip = write_clip(tmp_path / name, codec, options=options)
    if clip.suffix == ".mkv":  # whose frames have a head of their own
        position, size = packets(clip)[bad]
        data = bytearray(clip.read_bytes())
        start = data.index(b"\xff\xd8", position)
        data[start : start + size] = bytes(size)
        clip.write_bytes(data)
    else:
        overwrite(clip, bad)
    frames, (line,), source = read(clip)
    rest = [n for n in range(30) if n != bad]
    assert [number_of(f.image) for f in frames] == rest
    assert [f.index for f in frames] == rest
    assert [f.time_s for f in frames] == pytest.approx([n / FPS for n in rest], abs=2e-3)
    assert (source.errors, source.cut_short) == (1, False)
    assert line.startswith(f"{clip}: frame {bad} at {bad / FPS:.3f} s cannot be decoded: copy ")


def test_a_frame_that_is_decoded_only_in_part_is_left_out(tmp_path):
    clip = write_clip(tmp_path / "clip.avi")
    overwrite(clip, 12, share=0.5)
    frames, (line,), source = read(clip)
    assert [f.index for f in frames] == [n for n in range(30) if n != 12]
    assert "frame 12 at 0.600 s cannot be decoded" in line
    assert source.errors == 1


def test_frames_in_a_row_are_told_in_one_line(tmp_path):
    clip = write_clip(tmp_path / "clip.avi")
    for bad in (3, 4, 5, 20):
        overwrite(clip, bad)
    frames, lines, source = read(clip)
    assert len(frames) == 26
    assert [line.split(": ")[1] for line in lines] == [
        "frames 3 to 5 from 0.150 to 0.250 s cannot be decoded",
        "frame 20 at 1.000 s cannot be decoded",
    ]
    assert source.errors == 4


def test_frames_that_hang_on_a_bad_one_are_told_with_it(tmp_path):
    clip = write_clip(tmp_path / "clip.mp4", "libx264", options={"g": "10", "bf": "0"})
    overwrite(clip, 10)  # a key frame: up to the next one there is nothing to decode
    frames, lines, source = read(clip)
    assert len(frames) + source.errors == 30
    assert source.errors >= 1
    assert "10 " in lines[0]
    assert frames[-1].time_s == pytest.approx(29 / FPS, abs=2e-3)
    assert frames[-1].index == 29


def test_frames_that_the_index_lists_and_the_file_has_lost_are_told(tmp_path):
    clip = write_clip(tmp_path / "clip.avi")
    start, _ = packets(clip)[10]
    position, size = packets(clip)[12]
    data = bytearray(clip.read_bytes())
    data[start - 8 : position + size] = bytes(position + size - start + 8)  # with their heads
    clip.write_bytes(data)
    frames, lines, source = read(clip)
    assert len(frames) + source.errors == 30
    assert not source.cut_short
    assert any("of the 30 frames in the video's index" in line for line in lines)


def test_a_video_without_a_frame_is_refused(tmp_path):
    clip = write_clip(tmp_path / "clip.avi", numbers=range(4))
    for bad in range(4):
        overwrite(clip, bad)
    with pytest.raises(ChromadockError, match=r"no frame could be decoded: convert"):
        read(clip)


def test_the_reported_video_with_a_bad_first_frame_is_read():
    if not REPORTED.is_dir():
        pytest.skip(f"the reported videos are missing: {REPORTED}")
    frames, (line,), source = read(REPORTED / "frame0_zeroed.avi")
    assert [f.index for f in frames] == list(range(1, 30))
    assert "frame 0 at 0.000 s cannot be decoded" in line
    assert source.errors == 1


# --- a copy that was interrupted ---


@pytest.mark.parametrize(
    ("name", "codec", "muxer"),
    [
        ("clip.avi", "mjpeg", {}),
        ("clip.mkv", "mjpeg", {}),
        ("clip.mp4", "mpeg4", {"movflags": "faststart"}),
        ("clip.mp4", "libx264", FRAGMENTED),
    ],
)
@pytest.mark.parametrize("share", [0.6, 0.9])
def test_a_video_that_was_cut_short_is_used_and_told(tmp_path, name, codec, muxer, share):
    clip = write_clip(tmp_path / name, codec, muxer=muxer, options={"g": "3", "bf": "0"})
    cut(clip, share)
    frames, (line,), source = read(clip)
    assert 5 < len(frames) < 30
    assert [number_of(f.image) for f in frames] == list(range(len(frames)))
    assert source.cut_short
    assert line.startswith(f"{clip}: the video is cut short after {frames[-1].time_s:.3f} s (")
    assert line.endswith(
        f" bytes are missing): {len(frames)} frames could be used; copy it again for the rest"
    )


def test_an_mp4_that_was_cut_before_its_index_is_refused(tmp_path):
    clip = cut(write_clip(tmp_path / "clip.mp4", "mpeg4"), 0.9)
    with pytest.raises(ChromadockError, match=r"cut short .* nothing .* can be read: copy it"):
        read(clip)


def test_a_recording_that_was_not_finished_is_told(tmp_path):
    clip = write_clip(tmp_path / "clip.mp4", "mpeg4")
    data = clip.read_bytes()
    start = data.index(b"mdat") - 4
    clip.write_bytes(data[:start] + bytes(4) + data[start + 4 : data.index(b"moov") - 4])
    with pytest.raises(ChromadockError, match=r"not finished, so its index .* untrunc"):
        read(clip)


# --- what a video says of itself ---


@pytest.mark.parametrize(
    ("matrix", "corner"),
    [
        ((0, 1, -1, 0), (0, -1)),  # a quarter clockwise: the upper left comes to the upper right
        ((-1, 0, 0, -1), (-1, -1)),
        ((0, -1, 1, 0), (-1, 0)),
        ((1, 0, 0, 1), (0, 0)),
    ],
)
def test_a_phone_that_was_turned_is_turned_back(tmp_path, matrix, corner):
    path = tmp_path / "clip.mp4"
    image = np.zeros((64, 96, 3), np.uint8)
    image[:32, :32] = 255
    with av.open(str(path), "w") as container:
        stream = container.add_stream("mpeg4", rate=FPS)
        stream.width, stream.height, stream.pix_fmt = 96, 64, "yuv420p"
        container.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="bgr24")))
        container.mux(stream.encode(None))
    a, b, c, d = (value << 16 for value in matrix)
    patch(path, b"tkhd", 40, struct.pack(">9i", a, b, 0, c, d, 0, 0, 0, 1 << 30))
    ((frame,), _, _) = read(path)
    assert frame.image.shape == ((96, 64, 3) if matrix[0] == 0 else (64, 96, 3))
    row, column = corner
    assert frame.image[row or 4, column or 4].mean() > 200
    assert frame.image[32, 32].mean() < 128 or frame.image.shape[1] == 64
    assert frame.image.mean() == pytest.approx(255 / 6, abs=8)


def test_times_are_those_of_the_frames_and_not_of_a_rate(tmp_path):
    numbers = [0, 1, 5, 6, 20]
    well(write_clip(tmp_path / "clip.mkv", numbers=numbers), numbers)


def test_frames_without_a_time_get_the_next_one(tmp_path):
    path = write_clip(tmp_path / "clip.m4v", "mpeg4", numbers=range(5))  # frames and nothing else
    frames, lines, _ = read(path)
    assert lines == []
    assert [f.time_s for f in frames] == sorted({f.time_s for f in frames})
    assert len(frames) == 5


def test_sound_alone_is_no_video(tmp_path):
    path = tmp_path / "sound.mkv"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=8000, layout="mono")
        heard = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), "s16", "mono")
        heard.sample_rate = 8000
        container.mux(stream.encode(heard))
    with pytest.raises(ChromadockError, match="cannot be read as a video or picture"):
        read(path)


def test_a_name_with_a_colon_is_a_name(tmp_path, monkeypatch):
    write_clip(tmp_path / "2026-05-01T10:11:12.avi")
    monkeypatch.chdir(tmp_path)
    well("2026-05-01T10:11:12.avi", range(30))
