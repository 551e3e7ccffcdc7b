"""Tells from a video file's own headers whether its end is missing.

FFmpeg decodes what is left of a video that was cut short and says nothing, so the container's
sizes are compared with the file's.  They count bytes, so they say nothing of how many frames
there are: neither does a number of frames in a header, nor a duration.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

_MP4_FIRST = {b"ftyp", b"styp", b"moov", b"mdat", b"free", b"skip", b"wide"}
_EBML = b"\x1a\x45\xdf\xa3"
_SEGMENT = b"\x18\x53\x80\x67"
_RIFF_SLACK = 8
"""Some recorders write the size of the file where that of what follows these bytes is due."""


def missing_bytes(path: Path) -> int:
    """How many bytes the container announces beyond the end of the file.

    0 where the file is whole, its container is unknown (only MP4/MOV, AVI and
    Matroska/WebM are looked into) or leaves its size open, as streams do.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(12)
        if head[4:8] in _MP4_FIRST:
            announced = _mp4_end(file, size)
        elif head[:4] == b"RIFF":
            announced = _riff_end(file, size)
        elif head[:4] == _EBML:
            announced = _matroska_end(file)
        else:
            announced = 0
    return max(0, announced - size)


def whole_boxes(path: Path) -> int:
    """Where the last box of an MP4 ends that is all there, in bytes from its start; 0 for others.

    FFmpeg reads an MP4 of fragments whose last piece of index is cut only as far as this.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(8)[4:8] not in _MP4_FIRST:
            return 0
        return max((end for _, end in _mp4_boxes(file, size) if end <= size), default=0)


def lacks_index(path: Path) -> bool:
    """True for an MP4 without a ``moov``, which recorders write last: one lost its power, say."""
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(8)[4:8] not in _MP4_FIRST:
            return False
        return all(name != b"moov" for name, _ in _mp4_boxes(file, size))


def _mp4_end(file: BinaryIO, size: int) -> int:
    """Where the last top level box ends."""
    return max((end for _, end in _mp4_boxes(file, size)), default=0)


def _mp4_boxes(file: BinaryIO, size: int) -> Iterator[tuple[bytes, int]]:
    """Names and ends of the top level boxes: each has 32 bits of size and 4 letters."""
    position = 0
    while position + 8 <= size:
        file.seek(position)
        head = file.read(16)
        length = int.from_bytes(head[:4], "big")
        if not _is_name(head[4:8]):  # padding after the last box
            return
        if length == 1:  # the real size follows in 64 bits
            length = int.from_bytes(head[8:16], "big")
        if length == 0:  # up to the end of the file
            length = size - position
        if length < 8:
            return
        position += length
        yield head[4:8], position


def _riff_end(file: BinaryIO, size: int) -> int:
    """Where the last RIFF chunk ends; a large AVI has several, one after the other.

    Recorders that were switched off leave 0 as the size.
    """
    position = 0
    while position + 12 <= size:
        file.seek(position)
        head = file.read(8)
        length = int.from_bytes(head[4:8], "little")
        if head[:4] != b"RIFF" or length == 0:
            return position
        position += 8 + length + length % 2
    return position if position > size + _RIFF_SLACK else 0


def _is_name(letters: bytes) -> bool:
    """True for four printable letters of ASCII."""
    return len(letters) == 4 and all(0x20 <= letter < 0x7F for letter in letters)


def _matroska_end(file: BinaryIO) -> int:
    """Where the segment ends, which follows the EBML header."""
    file.seek(len(_EBML))
    header, _ = _variable_size(file)
    if header is None:
        return 0
    file.seek(header, os.SEEK_CUR)
    if file.read(4) != _SEGMENT:
        return 0
    length, _ = _variable_size(file)
    return 0 if length is None else file.tell() + length


def _variable_size(file: BinaryIO) -> tuple[int | None, int]:
    """EBML's size of 1 to 8 bytes and how many they were; None where it is unknown."""
    first = file.read(1)
    if not first or first[0] == 0:
        return None, 1
    width = 9 - first[0].bit_length()
    value = int.from_bytes(bytes([first[0] & (0xFF >> width)]) + file.read(width - 1), "big")
    return (None if value == (1 << 7 * width) - 1 else value), width
