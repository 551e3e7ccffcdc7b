"""Which files are recordings, and which topic is meant; apart from what reads them, which takes
long to load."""

from __future__ import annotations

from pathlib import Path

MCAP_MAGIC = b"\x89MCAP0\r\n"
_ROS_1_MAGIC = b"#ROSBAG V"
_SQLITE_MAGIC = b"SQLite format 3\0"
_OF_FOLDER = b"rosbag2_bagfile_information"
_TOPIC = "?topic="


def split_topic(text: str) -> tuple[str, str | None]:
    """``dive.mcap?topic=/camera/image`` as path and topic; None where none is given, as in
    addresses of video servers, which have topics of their own."""
    path, said, topic = text.partition(_TOPIC)
    return (path, topic) if said and "://" not in path else (text, None)


def is_mcap(path: Path) -> bool:
    """True for an MCAP file, however it is called."""
    return path.is_file() and _start(path).startswith(MCAP_MAGIC)


def is_bag(path: Path) -> bool:
    """True for an MCAP file, a ``.bag``, a ``.db3``, and the folder of a ROS 2 bag."""
    if path.is_dir():
        return _OF_FOLDER in _start(path / "metadata.yaml")
    start = _start(path) if path.is_file() else b""
    return (
        start.startswith(MCAP_MAGIC)
        or (start.startswith(_ROS_1_MAGIC) and path.suffix == ".bag")
        or (start.startswith(_SQLITE_MAGIC) and path.suffix == ".db3")
    )


def _start(path: Path) -> bytes:
    """Of what cannot be read, nothing: who reads it next says why."""
    try:
        with path.open("rb") as file:
            return file.read(256)
    except OSError:
        return b""
