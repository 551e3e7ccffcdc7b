"""Frames out of recordings that other programs made: MCAP files, ROS 2 bags, ROS 1 bags."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from mcap_ros2.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore
from simulation import chromadock

from chromadock.errors import ChromadockError
from chromadock.sources import Frame, open_source

START_NS = 1_800_000_000_123_456_789
STEP_NS = 50_000_000
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED = "sensor_msgs/msg/CompressedImage"

Message = dict[str, Any]

PICTURE = np.random.default_rng(3).integers(0, 256, (6, 8, 3), np.uint8)
"""BGR, no two pixels alike."""


def plain(encoding: str, pixels: np.ndarray, padding: int = 0) -> Message:
    """An Image; ``padding`` bytes follow each row."""
    rows = pixels.reshape(len(pixels), -1)
    padded = np.pad(rows, ((0, 0), (0, padding)), constant_values=77)
    return {
        "height": len(pixels), "width": pixels.shape[1], "encoding": encoding,
        "is_bigendian": 0, "step": padded.shape[1], "data": padded.tobytes(),
    }  # fmt: skip


def packed(suffix: str = ".png", pixels: np.ndarray = PICTURE) -> Message:
    """A CompressedImage."""
    data = cv2.imencode(suffix, pixels)[1].tobytes()
    return {"format": f"bgr8; {suffix[1:]} compressed bgr8", "data": data}


def stamped(fields: Message, index: int, late_ns: int = 7_000_000) -> tuple[int, Message]:
    """When it was logged, later than its header says, and the message."""
    stamp_ns = START_NS + index * STEP_NS
    time = {"sec": stamp_ns // 10**9, "nanosec": stamp_ns % 10**9}
    return stamp_ns + late_ns, {"header": {"stamp": time, "frame_id": "eye"}, **fields}


DEFINITION = """std_msgs/Header header
{fields}
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""
FIELDS = {
    IMAGE: "uint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
    "uint8[] data",
    COMPRESSED: "string format\nuint8[] data",
    "std_msgs/msg/String": "string data",
}

Topics = dict[str, tuple[str, Sequence[Message]]]


def write_mcap(path: Path, topics: Topics, unstamped: bool = False) -> Path:
    """By the ROS 2 writer of the mcap library, whose encoder we do not use."""
    with path.open("wb") as file:
        writer = McapWriter(file)
        for topic, (kind, messages) in topics.items():
            schema = writer.register_msgdef(kind, DEFINITION.format(fields=FIELDS[kind]))
            for index, fields in enumerate(messages):
                logged_ns, message = stamped(fields, index)
                if unstamped:
                    message["header"]["stamp"] = {"sec": 0, "nanosec": 0}
                writer.write_message(topic, schema, message, logged_ns, logged_ns)
        writer.finish()
    return path


def ros_message(store: Any, kind: str, fields: Message, index: int, ros1: bool) -> Any:
    stamp = stamped(fields, index)[1]["header"]["stamp"]
    header = {"stamp": store.types["builtin_interfaces/msg/Time"](**stamp), "frame_id": "eye"}
    if ros1:
        header["seq"] = index
    fields = {**fields, "data": np.frombuffer(fields["data"], np.uint8)}
    return store.types[kind](header=store.types["std_msgs/msg/Header"](**header), **fields)


def write_ros2(path: Path, topics: Topics, storage: StoragePlugin) -> Path:
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer2(path, version=9, storage_plugin=storage) as writer:
        for topic, (kind, messages) in topics.items():
            connection = writer.add_connection(topic, kind, typestore=store)
            for index, fields in enumerate(messages):
                data = store.serialize_cdr(ros_message(store, kind, fields, index, False), kind)
                writer.write(connection, stamped(fields, index)[0], data)
    return path


def write_ros1(path: Path, topics: Topics) -> Path:
    store = get_typestore(Stores.ROS1_NOETIC)
    with Writer1(path) as writer:
        for topic, (kind, messages) in topics.items():
            connection = writer.add_connection(topic, kind, typestore=store)
            for index, fields in enumerate(messages):
                data = store.serialize_ros1(ros_message(store, kind, fields, index, True), kind)
                writer.write(connection, stamped(fields, index)[0], data)
    return path


THREE: Topics = {"/eye": (IMAGE, [plain("bgr8", PICTURE + k) for k in range(3)])}


def read(text: object, told: list[str] | None = None) -> list[Frame]:
    with open_source(str(text), on_fault=(told if told is not None else []).append) as source:
        return list(source)


def recordings(folder: Path, topics: Topics) -> Iterator[Path]:
    yield write_mcap(folder / "a.mcap", topics)
    yield write_mcap(folder / "named_otherwise", topics)
    yield write_ros2(folder / "sqlite", topics, StoragePlugin.SQLITE3)
    yield next((folder / "sqlite").glob("*.db3"))
    yield write_ros2(folder / "mcap", topics, StoragePlugin.MCAP)
    yield next((folder / "mcap").glob("*.mcap"))
    yield write_ros1(folder / "a.bag", topics)


def test_every_kind_of_recording_gives_its_pictures_at_the_time_of_their_headers(
    tmp_path: Path,
) -> None:
    compressed: Topics = {"/eye": (COMPRESSED, [packed(pixels=PICTURE + k) for k in range(3)])}
    for number, topics in enumerate((THREE, compressed)):
        folder = tmp_path / str(number)
        folder.mkdir()
        for path in recordings(folder, topics):
            with open_source(str(path)) as source:
                got = list(source)
                assert (source.count, source.cut_short, source.live) == (3, False, False), path
                assert source.fps == pytest.approx(20), path
            assert [f.time_s for f in got] == [0, 0.05, 0.1], path
            assert [f.index for f in got] == [0, 1, 2]
            for k, frame in enumerate(got):
                assert np.array_equal(frame.image, PICTURE + k), path


BAYER = {
    "bayer_rggb8": ((2, 1), (1, 0)),
    "bayer_bggr8": ((0, 1), (1, 2)),
    "bayer_gbrg8": ((1, 0), (2, 1)),
    "bayer_grbg8": ((1, 2), (0, 1)),
}
"""Which channel of BGR the pixels of the first two rows show, as the name has it."""


@pytest.mark.parametrize("padding", [0, 5])
@pytest.mark.parametrize(
    ("encoding", "pixels"),
    [
        ("bgr8", PICTURE),
        ("rgb8", PICTURE[..., ::-1]),
        ("bgra8", np.dstack([PICTURE, PICTURE[..., 0]])),
        ("rgba8", np.dstack([PICTURE[..., ::-1], PICTURE[..., 0]])),
        ("8UC3", PICTURE),
    ],
)
def test_every_order_of_colours_becomes_bgr(
    tmp_path: Path, encoding: str, pixels: np.ndarray, padding: int
) -> None:
    message = plain(encoding, pixels, padding)
    frame, = read(write_mcap(tmp_path / "a.mcap", {"/eye": (IMAGE, [message])}))  # fmt: skip
    assert np.array_equal(frame.image, PICTURE)


@pytest.mark.parametrize("encoding", ["mono8", "8UC1"])
def test_grey_becomes_three_equal_channels(tmp_path: Path, encoding: str) -> None:
    message = plain(encoding, PICTURE[..., 0], 3)
    frame, = read(write_mcap(tmp_path / "a.mcap", {"/eye": (IMAGE, [message])}))  # fmt: skip
    assert np.array_equal(frame.image, np.repeat(PICTURE[..., :1], 3, axis=2))


@pytest.mark.parametrize("encoding", BAYER)
def test_a_mosaic_becomes_the_colour_that_it_was_taken_of(tmp_path: Path, encoding: str) -> None:
    colour = np.array([200, 120, 30], np.uint8)
    mosaic = np.tile(colour[np.array(BAYER[encoding])], (4, 4))
    message = plain(encoding, mosaic)
    frame, = read(write_mcap(tmp_path / "a.mcap", {"/eye": (IMAGE, [message])}))  # fmt: skip
    assert np.array_equal(frame.image, np.broadcast_to(colour, (8, 8, 3)))


def test_without_stamps_the_time_of_logging_counts(tmp_path: Path) -> None:
    got = read(write_mcap(tmp_path / "a.mcap", THREE, unstamped=True))
    assert [f.time_s for f in got] == [0, 0.05, 0.1]


def test_several_topics_are_listed_and_one_is_chosen(tmp_path: Path) -> None:
    other = [plain("mono8", PICTURE[..., 0])]
    path = write_mcap(tmp_path / "a.mcap", {**THREE, "/down/image": (IMAGE, other)})
    with pytest.raises(ChromadockError) as refused:
        read(path)
    assert str(refused.value) == (
        f"{path}: several topics of pictures: give {path}?topic= with one of /eye, /down/image"
    )
    assert len(read(f"{path}?topic=/eye")) == 3
    assert len(read(f"{path}?topic=/down/image")) == 1
    with pytest.raises(ChromadockError, match=r"no pictures in /up: .* one of /eye, /down/image"):
        read(f"{path}?topic=/up")


def test_a_topic_of_what_has_none_is_refused(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "a.png"), PICTURE)
    with pytest.raises(ChromadockError, match=r"no recording, so it has no topic"):
        read(f"{tmp_path / 'a.png'}?topic=/eye")
    with pytest.raises(ChromadockError, match="no such file or folder"):
        read(f"{tmp_path / 'none.mcap'}?topic=/eye")


def test_a_recording_without_pictures_says_what_it_has(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = McapWriter(file)
        text = writer.register_msgdef("std_msgs/msg/String", "string data")
        writer.write_message("/talk", text, {"data": "x"}, 1, 1)
        writer.finish()
    with pytest.raises(ChromadockError, match=r"no pictures in it, but /talk \(std_msgs/msg/St"):
        read(path)


@pytest.mark.parametrize(
    ("message", "said"),
    [
        (plain("16UC1", PICTURE[..., 0]), "pictures of encoding '16UC1' cannot be read"),
        (plain("bgr8", PICTURE) | {"data": b"abc"}, "8x6 pixels with 3 bytes: it is not whole"),
        (plain("bgr8", PICTURE) | {"step": 9}, "it is not whole"),
    ],
)
def test_a_picture_that_is_none_is_left_out_and_told(
    tmp_path: Path, message: Message, said: str
) -> None:
    good = plain("bgr8", PICTURE)
    path = write_mcap(tmp_path / "a.mcap", {"/eye": (IMAGE, [good, message, good])})
    told: list[str] = []
    with open_source(str(path), on_fault=told.append) as source:
        assert [f.index for f in source] == [0, 2]
        assert source.errors == 1
    line, = told  # fmt: skip
    assert "/eye, message 1" in line and said in line and line.endswith("(skipped)")


def test_a_jpeg_that_breaks_off_is_left_out(tmp_path: Path) -> None:
    whole = packed(".jpg", np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8))
    cut = whole | {"data": whole["data"][: len(whole["data"]) // 2]}
    told: list[str] = []
    got = read(write_mcap(tmp_path / "a.mcap", {"/eye": (COMPRESSED, [cut, whole])}), told)
    assert len(got) == 1 and "not a whole picture" in told[0]


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9, 0.99])
def test_a_recording_that_breaks_off_gives_what_there_is_and_a_line(
    tmp_path: Path, share: float
) -> None:
    content = io.BytesIO()
    writer = McapWriter(content, chunk_size=300)
    schema = writer.register_msgdef(IMAGE, DEFINITION.format(fields=FIELDS[IMAGE]))
    for index in range(40):
        logged_ns, message = stamped(plain("bgr8", PICTURE + index), index)
        writer.write_message("/eye", schema, message, logged_ns, logged_ns)
    writer.finish()
    whole = content.getvalue()
    path = tmp_path / "a.mcap"
    path.write_bytes(whole[: int(share * len(whole))])
    told: list[str] = []
    with open_source(str(path), on_fault=told.append) as source:
        got = list(source)
        assert source.cut_short
    assert 0.5 * share * 40 < len(got) <= 40
    assert all(np.array_equal(f.image, PICTURE + f.index) for f in got)
    assert len(told) == 1 and "cut short (it was never finished" in told[0]


def test_a_recording_with_a_spoilt_byte_gives_what_is_before_it(tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "a.mcap", {"/eye": (IMAGE, [plain("bgr8", PICTURE)] * 3)})
    content = bytearray(path.read_bytes())
    content[150] ^= 0xFF  # in the first piece
    path.write_bytes(content)
    told: list[str] = []
    assert read(path, told) == []
    assert len(told) == 1 and "cut short (byte" in told[0]


@pytest.mark.parametrize("name", ["a.bag", "a.db3", "folder"])
def test_a_bag_that_is_broken_is_one_line(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    if name == "folder":
        path.mkdir()
        (path / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 9\n")
    else:
        start = b"#ROSBAG V2.0\n" if name == "a.bag" else b"SQLite format 3\0"
        path.write_bytes(start + bytes(100))
    with pytest.raises(ChromadockError, match="cannot be read as a bag") as refused:
        read(path)
    assert "\n" not in str(refused.value) and str(path) in str(refused.value)


def test_detect_looks_into_a_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_ros2(tmp_path / "bag", THREE, StoragePlugin.MCAP)
    done = chromadock(capsys, "detect", path, "--json")
    assert done.status == 0 and len(done.out.splitlines()) == 3
    shorter = path / "bag.mcap"
    shorter.write_bytes(shorter.read_bytes()[:-40])
    done = chromadock(capsys, "detect", shorter, "--json")
    assert done.status == 1 and len(done.out.splitlines()) == 3
    assert "cut short" in done.err


def test_a_topic_in_an_address_is_the_server_s() -> None:
    """As of ROS's web_video_server."""
    with pytest.raises(ChromadockError, match=r"^http://127\.0\.0\.1:1/stream\.\.\.: does not"):
        read("http://127.0.0.1:1/stream?topic=/camera/image")
