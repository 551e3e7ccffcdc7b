"""Finds MAVLink 2 messages among anything else: boot text, driver text, noise.

A start that turns out false costs its first byte only; the search goes on with the byte
behind it, so that one damaged message never swallows the next.  A whole message is passed over
with all that it carries, which may look like messages; one of another dialect, whose checksum
cannot be computed, counts as whole where another message or silence follows right behind it.
The dock's receiver does the same.
"""

from __future__ import annotations

import struct
from collections import Counter
from typing import Any

from pymavlink.generator.mavcrc import x25crc

from chromadock import dialect

START, START_1 = 0xFD, 0xFE
"""The first byte of a message, by MAVLink's version; only those of version 2 are found."""
HEADER_BYTES = 10
CHECKSUM_BYTES = 2
SIGNATURE_BYTES = 13
_SIGNED = 1
_MOST_IDS = 0x10000
"""No dialect has a higher one; noise mostly has."""

Message = Any
"""A message of ``chromadock.dialect``."""


class FrameFinder:
    """Bytes in, in any pieces; messages out.

    Attributes
    ----------
    skipped
        Bytes so far that belong to no message.
    rejected
        How often each message id was seen with a wrong checksum.  Noise adds to it, too.
    """

    def __init__(self) -> None:
        self.skipped = 0
        self.rejected: Counter[int] = Counter()
        self._bytes = bytearray()
        self._decoder = dialect.MAVLink(None)

    def feed(self, data: bytes) -> list[Message]:
        """The messages that are complete with ``data``, in the order of the stream."""
        self._bytes += data
        return self._found()

    def give_up(self) -> list[Message]:
        """For when the line has fallen silent: what is waited for will not come.

        Drops the unfinished start and returns the messages that stood behind it.
        """
        found: list[Message] = []
        while self._bytes:
            length = self._length(0)
            self._skip(length if length and self._is_foreign() else 1)
            found += self._found()
        return found

    def _found(self) -> list[Message]:
        found: list[Message] = []
        while True:
            start = self._bytes.find(START)
            self._skip(len(self._bytes) if start < 0 else start)
            length = self._length()
            if length is None:
                return found
            if length and self._is_foreign():
                self._skip(length if self._bytes[length] in (START, START_1) else 1)
                continue
            message = self._message(length) if length else None
            if message is None:
                self._skip(1)
            else:
                found.append(message)
                del self._bytes[:length]

    def _skip(self, count: int) -> None:
        self.skipped += count
        del self._bytes[:count]

    def _is_foreign(self) -> bool:
        return _id(self._bytes) not in dialect.mavlink_map

    def _length(self, behind: int = 1) -> int | None:
        """Bytes of the message at the start; 0: none can be there; None: not yet known, or
        not all here, with ``behind`` bytes of what follows one of another dialect."""
        b = self._bytes
        if len(b) < HEADER_BYTES:
            # Flags and id tell most false starts before their message is long enough.
            return 0 if len(b) > 2 and b[2] & ~_SIGNED else None
        if b[2] & ~_SIGNED or not _is_plausible(_id(b)):
            return 0
        signature = SIGNATURE_BYTES if b[2] & _SIGNED else 0
        length = HEADER_BYTES + b[1] + CHECKSUM_BYTES + signature
        return length if len(b) >= length + (behind if self._is_foreign() else 0) else None

    def _message(self, length: int) -> Message | None:
        b = self._bytes[:length]
        end = HEADER_BYTES + b[1]
        number = _id(b)
        crc = x25crc(b[1:end])
        crc.accumulate(bytes([dialect.mavlink_map[number].crc_extra]))
        if struct.pack("<H", crc.crc) != b[end : end + CHECKSUM_BYTES]:
            self.rejected[number] += 1
            return None
        try:
            return self._decoder.decode(bytearray(b))
        except dialect.MAVError:
            return None


def _id(b: bytearray) -> int:
    return int.from_bytes(b[7:10], "little")


def _is_plausible(number: int) -> bool:
    """Whether a header with this id may be a message's: one that is known, or such as noise and
    halves of messages hardly make."""
    halves = number & 0xFF, number >> 8
    foreign = number < _MOST_IDS and START not in halves and START_1 not in halves
    return number in dialect.mavlink_map or foreign
