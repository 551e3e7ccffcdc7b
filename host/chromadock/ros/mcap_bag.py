"""Reads MCAP files of ROS messages, also those that break off."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any, BinaryIO, cast

from mcap.exceptions import EndOfFile, McapError
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Chunk, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from rosbags.serde import SerdeError
from rosbags.typesys import (
    Stores,
    TypesysError,
    get_types_from_idl,
    get_types_from_msg,
    get_typestore,
)

from chromadock.errors import ChromadockError
from chromadock.ros.bags import Bag, Topic
from chromadock.text import one_line

_SPOILT = (McapError, struct.error, ValueError, LookupError, RuntimeError, MemoryError)
"""What a record that is cut or spoilt does to the library that reads it."""

Decoder = Callable[[bytes], Any]


class McapBag(Bag):
    """An MCAP file, read from its start to wherever it ends, with an index there or without.

    Raises
    ------
    ChromadockError
        Where nothing of it can be read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        channels, counts = _summary(path) or self._scanned()
        kinds = {key: _kind(schema) for key, (_, schema) in channels.items()}
        self.topics = [
            Topic(channel.topic, kinds[key], counts[key]) for key, (channel, _) in channels.items()
        ]

    def messages(self, topic: str) -> Iterator[tuple[int, Any]]:
        """See ``Bag``."""
        schemas: dict[int, Schema] = {}
        decoders: dict[int, Decoder] = {}
        for record in self._records():
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                if record.topic == topic and record.id not in decoders:
                    decoders[record.id] = self._decoder(record, schemas.get(record.schema_id))
            elif isinstance(record, Message) and record.channel_id in decoders:
                yield record.log_time, decoders[record.channel_id](record.data)

    def close(self) -> None:
        """Nothing is open between two readings."""

    def _records(self) -> Iterator[McapRecord]:
        """All that can be read; ``cut_short`` says where that is not all."""
        with self._path.open("rb") as file:
            reader = StreamReader(cast(IO[bytes], _Whole(file)), validate_crcs=True)
            try:
                yield from reader.records
            except EndOfFile:
                self.cut_short = "it was never finished, as by a kill or a loss of power"
            except _SPOILT as error:
                self.cut_short = f"byte {file.tell()}: {one_line(error, 80)}"

    def _scanned(self) -> tuple[dict[int, tuple[Channel, Schema | None]], Counter[int]]:
        """Channels by their number, and how many messages each has, where no index tells."""
        schemas: dict[int, Schema] = {}
        channels: dict[int, tuple[Channel, Schema | None]] = {}
        counts = Counter[int]()
        for record in self._records():
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record, schemas.get(record.schema_id)
            elif isinstance(record, Message):
                counts[record.channel_id] += 1
        return channels, counts

    def _decoder(self, channel: Channel, schema: Schema | None) -> Decoder:
        try:
            return _decoder(channel, schema)
        except (TypesysError, SerdeError, KeyError) as error:
            raise ChromadockError(
                f"{self._path}: the messages of {channel.topic} cannot be read "
                f"({one_line(error, 80)}): record them with ROS 2, or ROS 1"
            ) from None


def head(path: Path) -> tuple[dict[str, bytes], dict[str, dict[str, str]]]:
    """Attachments and metadata before the second piece of an MCAP file, by their names.

    There a recording of Chromadock has its settings.
    """
    attachments: dict[str, bytes] = {}
    metadata: dict[str, dict[str, str]] = {}
    chunks = 0
    with path.open("rb") as file:
        reader = StreamReader(cast(IO[bytes], _Whole(file)), emit_chunks=True)
        try:
            for record in reader.records:
                if isinstance(record, Attachment):
                    attachments.setdefault(record.name, record.data)
                elif isinstance(record, Metadata):
                    metadata.setdefault(record.name, record.metadata)
                chunks += isinstance(record, Chunk)
                if chunks > 1:
                    break
        except _SPOILT:  # told by who reads the messages
            pass
    return attachments, metadata


class _Whole:
    """A file that has ended where it has less than is asked for; the library would go on with
    half a record."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def read(self, size: int) -> bytes:
        """So many bytes, or none."""
        data = self._file.read(size)
        return data if len(data) == size else b""


def _summary(
    path: Path,
) -> tuple[dict[int, tuple[Channel, Schema | None]], Counter[int]] | None:
    """The same by the index at the end; None where there is none."""
    with path.open("rb") as file:
        try:
            summary = make_reader(file).get_summary()
        except (*_SPOILT, OSError):
            return None
    if summary is None or summary.statistics is None or not summary.channels:
        return None
    channels = {
        key: (channel, summary.schemas.get(channel.schema_id))
        for key, channel in summary.channels.items()
    }
    return channels, Counter(summary.statistics.channel_message_counts)


def _kind(schema: Schema | None) -> str:
    """A type's name as in ROS 2; ROS 1 has none of the middle part."""
    if schema is None:
        return "unknown"
    return schema.name if schema.encoding != "ros1msg" else schema.name.replace("/", "/msg/", 1)


def _decoder(channel: Channel, schema: Schema | None) -> Decoder:
    """From bytes to a message, by the definition that the file has of it."""
    if schema is None or schema.encoding not in ("ros1msg", "ros2msg", "ros2idl"):
        raise KeyError(f"schema {schema and schema.encoding}, encoding {channel.message_encoding}")
    kind, text = _kind(schema), schema.data.decode()
    store = get_typestore(Stores.EMPTY)
    if schema.encoding == "ros2idl":
        store.register(get_types_from_idl(text))
    else:
        store.register(get_types_from_msg(text, kind))
    deserialize = (
        store.deserialize_ros1 if channel.message_encoding == "ros1" else store.deserialize_cdr
    )
    return lambda data: deserialize(data, kind)
