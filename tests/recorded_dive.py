"""A short dive that tests record, and how they open and read its recording."""

from __future__ import annotations

import contextlib
import io
import struct
from pathlib import Path
from typing import Any

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2.decoder import DecoderFactory

from chromadock.output import ResultOutput, Surroundings
from chromadock.output import open_output as open_named

COUNT = 12

Messages = dict[str, list[tuple[int, Any]]]


def open_output(text: str) -> ResultOutput:
    return open_named(text, Surroundings(None, print))


def read(path: Path) -> Messages:
    """Time and message of every topic, by the mcap library's own decoder."""
    found: Messages = {}
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    return found


def recovered(path: Path) -> tuple[Messages, set[str]]:
    """The same of a file without an end, up to its last whole piece; and its attachments."""
    found: Messages = {}
    names: set[str] = set()
    content = path.read_bytes()
    reader = NonSeekingReader(io.BytesIO(content), decoder_factories=[DecoderFactory()])
    with contextlib.suppress(EndOfFile, struct.error, ValueError):
        for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    with contextlib.suppress(EndOfFile, struct.error, ValueError):
        for attachment in NonSeekingReader(io.BytesIO(content)).iter_attachments():
            names.add(attachment.name)
    return found, names
