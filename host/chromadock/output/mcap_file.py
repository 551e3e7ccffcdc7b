"""An MCAP file of ROS 2 messages that can be read however it ends."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import IO, cast

from mcap.well_known import Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from chromadock.output.growing_file import GrowingFile
from chromadock.output.run_setup import chromadock_version
from chromadock.ros.fields import Fields
from chromadock.ros.topics import METADATA, START, TOPICS
from chromadock.ros.types import definition, serialised


class McapFile:
    """Messages go to memory; only ``flush``, ``sync`` and ``finish`` touch the disk.

    All three raise ``OSError``, and can be called again after it.

    Parameters
    ----------
    path : of the new file; see ``GrowingFile``.
    files : attached at the start, by name.

    Raises
    ------
    ChromadockError
        Where there can be no such file.
    """

    def __init__(self, path: Path, files: Mapping[str, bytes]) -> None:
        self._file = GrowingFile(path)
        self.path = self._file.path
        # Pictures are compressed already.
        stream = cast(IO[bytes], self._file)
        self._writer = Writer(stream, compression=CompressionType.NONE)
        self._writer.start(Profile.ROS2, f"chromadock {chromadock_version()}".strip())
        now_ns = time.time_ns()
        for name, content in files.items():
            kind = f"application/{Path(name).suffix.removeprefix('.')}"
            self._writer.add_attachment(now_ns, now_ns, name, kind, content)
        self._channels = {topic: self._channel(topic, kind) for topic, kind in TOPICS.items()}

    def _channel(self, topic: str, kind: str) -> int:
        text = definition(kind).encode()
        schema = self._writer.register_schema(kind, SchemaEncoding.ROS2, text)
        return self._writer.register_channel(topic, "cdr", schema)

    def start(self, start_ns: int) -> None:
        """Note when ``Frame.time_s`` was 0, Unix nanoseconds."""
        about = {START: str(start_ns), "version": chromadock_version()}
        self._writer.add_metadata(METADATA, about)

    def put(self, topic: str, fields: Fields, stamp_ns: int, index: int) -> None:
        """Take a message of the frame ``index`` that was taken then."""
        data = serialised(TOPICS[topic], fields)
        self._writer.add_message(self._channels[topic], stamp_ns, data, stamp_ns, index)

    def flush(self) -> None:
        """Give the system all messages so far, as a piece that can be read by itself."""
        self._writer.flush()

    def sync(self) -> None:
        """Wait until the disk has what the system has."""
        self._file.sync()

    def finish(self) -> None:
        """Write the index, after which nothing is put any more."""
        self._writer.finish()
        self._file.flush()
        self._file.sync()

    def close(self) -> None:
        """Let go of the file, finished or not."""
        self._file.close()
