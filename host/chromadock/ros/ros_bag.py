"""Reads the bags of ROS 1 and ROS 2 that are no single MCAP file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.rosbag1 import ReaderError as Reader1Error
from rosbags.rosbag2 import ReaderError as Reader2Error
from rosbags.typesys import Stores, get_typestore

from chromadock.errors import ChromadockError
from chromadock.ros.bags import Bag, Topic
from chromadock.text import one_line

_FAULTS = (AnyReaderError, Reader1Error, Reader2Error, OSError, ValueError, LookupError)


class RosBag(Bag):
    """A ``.bag`` of ROS 1, a ``.db3`` of ROS 2, or the folder of a ROS 2 bag.

    Raises
    ------
    ChromadockError
        Where it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            # Bags of ROS 2 before Iron in SQLite do not tell their types.
            types = get_typestore(Stores.ROS2_HUMBLE)
            self._reader = AnyReader([path], default_typestore=types)
            self._reader.open()
        except _FAULTS as error:
            raise self._unreadable(error) from None
        self.topics = [
            Topic(name, info.msgtype or "several", info.msgcount)
            for name, info in self._reader.topics.items()
        ]

    def messages(self, topic: str) -> Iterator[tuple[int, Any]]:
        """See ``Bag``."""
        chosen = [c for c in self._reader.connections if c.topic == topic]
        try:
            for connection, logged_ns, data in self._reader.messages(chosen):
                yield logged_ns, self._reader.deserialize(data, connection.msgtype)
        except _FAULTS as error:
            self.cut_short = one_line(error, 80)

    def close(self) -> None:
        """Let go of the files."""
        self._reader.close()

    def _unreadable(self, error: Exception) -> ChromadockError:
        return ChromadockError(
            f"{self._path}: cannot be read as a bag ({one_line(error, 80)}): copy it again, or "
            "mend it with `rosbag reindex` or `ros2 bag reindex`"
        )
