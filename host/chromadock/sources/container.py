"""Tells from a video file's own headers whether its end is missing.

FFmpeg decodes what is left of a video that was cut short and says nothing that OpenCV
passes on, so the container's sizes are compared with the file's.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

_MP4_FIRST = {b"ftyp", b"moov", b"mdat", b"free", b"skip", b"wide"}
_EBML = b"\x1a\x45\xdf\xa3"
_SEGMENT = b"\x18\x53\x80\x67"


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
            announced = _riff_end(head)
        elif head[:4] == _EBML:
            announced = _matroska_end(file)
        else:
            announced = 0
    return max(0, announced - size)


def counts_frames(path: Path) -> bool:
    """True where the container stores its number of frames, False where OpenCV guesses
    it from the duration."""
    with path.open("rb") as file:
        head = file.read(12)
    return head[4:8] in _MP4_FIRST or head[:4] == b"RIFF"


def _mp4_end(file: BinaryIO, size: int) -> int:
    """Where the last top level box ends: each has 32 bits of size and 4 letters."""
    position = 0
    while position + 8 <= size:
        file.seek(position)
        head = file.read(16)
        length = int.from_bytes(head[:4], "big")
        if length == 1:  # the real size follows in 64 bits
            length = int.from_bytes(head[8:16], "big")
        if length == 0:  # up to the end of the file
            return size
        if length < 8:
            return 0
        position += length
    return position


def _riff_end(head: bytes) -> int:
    """Where the first RIFF chunk ends; recorders that were switched off leave 0 there."""
    length = int.from_bytes(head[4:8], "little")
    return 8 + length if length else 0


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
