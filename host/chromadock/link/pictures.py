"""Camera frames over the link: a snapshot from the dock, a frame injected into it."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, field
from functools import partial

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link.commands import ask_for_message, command
from chromadock.link.framing import Message
from chromadock.link.messenger import Messenger

PAYLOAD = 253
RGB565 = dialect.MAVLINK_DATA_STREAM_IMG_RAW8U
RGB888 = dialect.MAVLINK_DATA_STREAM_IMG_RAW32U
"""The dialect has no name for either; these two stand for them."""

_TRIES = 4
_FRUITLESS = 4
"""Requests for packets in a row that bring none."""
_QUIET_S = 0.5


@dataclass(frozen=True)
class _Picture:
    """What is known of a picture on its way: its announcement, if that came, and packets."""

    size: int = 0
    width: int = 0
    height: int = 0
    count: int = 0
    number: int = 0
    """By which its packets can be asked for again; 0 of older firmware."""
    packets: dict[int, bytes] = field(default_factory=dict)

    def after(self, part: Message) -> _Picture:
        """With a handshake, which begins a picture anew, or a packet."""
        if _is_handshake(part):
            return _Picture(part.size, part.width, part.height, part.packets, part.jpg_quality)
        if part.seqnr < self.count:
            self.packets[part.seqnr] = bytes(part.data)
        return self

    @property
    def is_whole(self) -> bool:
        """All of it has come, and it is RGB565."""
        return 0 < self.count == len(self.packets) and self.size == 2 * self.width * self.height

    @property
    def data(self) -> bytes:
        """The pixels of a whole picture."""
        return b"".join(self.packets[i] for i in range(self.count))[: self.size]

    @property
    def missing_count(self) -> int:
        return self.count - len(self.packets)

    def gap(self) -> tuple[int, int]:
        """The first packet that is missing, and how many in a row are."""
        first = next(i for i in range(self.count) if i not in self.packets)
        beyond = next((i for i in range(first, self.count) if i in self.packets), self.count)
        return first, beyond - first


def snapshot(messenger: Messenger) -> tuple[bytes, int, int]:
    """The next camera frame: RGB565 bytes, width, height.

    Packets that were lost are asked for again, of the same picture; of a dock that cannot do
    that, a new picture.

    Raises
    ------
    ChromadockError
        Where no whole frame comes in several tries.
    """
    lost = "its announcement was lost"
    for _ in range(_TRIES):
        command(messenger, dialect.MAV_CMD_DOCK_SNAPSHOT, "a snapshot")
        first = messenger.wait(_is_part, messenger.patience_s)
        if first is None:
            raise ChromadockError(
                f"{messenger.connection.url}: the dock's camera gives no frame within "
                f"{messenger.patience_s:g} s: see `chromadock dock watch`, or wait longer with "
                "--timeout"
            )
        picture = _completed(messenger, _listened(messenger, _Picture().after(first)))
        if picture.is_whole:
            return picture.data, picture.width, picture.height
        if picture.count:
            lost = f"{picture.missing_count} of {picture.count} packets were lost"
    raise ChromadockError(
        f"{messenger.connection.url}: no snapshot in {_TRIES} tries ({lost}): "
        "check the cable and `chromadock dock watch`"
    )


def inject(
    messenger: Messenger, data: bytes, width: int, height: int, kind: int = RGB565
) -> Message:
    """Let the dock decide on this frame instead of its camera's; the DOCK_STATUS after it.

    Parameters
    ----------
    data
        ``RGB565`` (big-endian, two bytes a pixel) or ``RGB888`` (three), as ``kind`` says.

    Raises
    ------
    ChromadockError
        Where the dock refuses it or packets are lost again and again.
    """
    pieces = [data[i : i + PAYLOAD] for i in range(0, len(data), PAYLOAD)]
    start = dialect.MAVLink_data_transmission_handshake_message(
        kind, len(data), width, height, len(pieces), PAYLOAD, 0
    )
    for _ in range(_TRIES):
        answer = messenger.ask(start, _is_echo, "an injected frame")
        if answer.get_type() == "STATUSTEXT":
            raise ChromadockError(
                f"{messenger.connection.url}: {width}x{height}: {answer.text}: give a smaller frame"
            )
        before = _status(messenger).frames  # from now on the camera's are passed over
        for number, piece in enumerate(pieces):
            messenger.send(
                dialect.MAVLink_encapsulated_data_message(number, piece.ljust(PAYLOAD, b"\0"))
            )
        status = messenger.wait(partial(_is_outcome, before), _QUIET_S) or _status(messenger)
        if status.get_type() == "DOCK_STATUS" and status.frames > before:
            return status
    raise ChromadockError(
        f"{messenger.connection.url}: the dock missed parts of a frame in {_TRIES} tries: "
        "check the cable, or set a lower LINK_BAUD"
    )


def end_injection(messenger: Messenger) -> None:
    """Give the dock its camera back at once; by itself it does so after three seconds."""
    messenger.send(
        dialect.MAVLink_data_transmission_handshake_message(RGB565, 0, 0, 0, 0, PAYLOAD, 0)
    )


def _status(messenger: Messenger) -> Message:
    return ask_for_message(messenger, dialect.MAVLINK_MSG_ID_DOCK_STATUS, "DOCK_STATUS")


def _listened(messenger: Messenger, picture: _Picture, end: int | None = None) -> _Picture:
    """The picture with what comes of it, up to packet ``end`` - 1, its last one where that is
    None, or until nothing comes any more.

    An answer that was lost and repeated may have begun a newer one: then that.
    """
    while True:
        part = messenger.wait(_is_part, _QUIET_S)
        if part is None:
            return picture
        picture = picture.after(part)
        if _is_handshake(part):
            end = None
        elif part.seqnr == (picture.count if end is None else end) - 1:
            return picture


def _completed(messenger: Messenger, picture: _Picture) -> _Picture:
    """With the packets that were lost, as far as the dock sends them again."""
    fruitless = 0
    while picture.missing_count and picture.number and fruitless < _FRUITLESS:
        missing, (first, count) = picture.missing_count, picture.gap()
        with contextlib.suppress(ChromadockError):  # refused, as it has a newer one
            wanted = (picture.number, first, count)
            command(messenger, dialect.MAV_CMD_DOCK_SNAPSHOT, "a snapshot", *wanted)
            picture = _listened(messenger, picture, first + count)
        fruitless = fruitless + 1 if picture.missing_count >= missing else 0
    return picture


def _is_part(message: Message) -> bool:
    return _is_handshake(message) or bool(message.get_type() == "ENCAPSULATED_DATA")


def _is_handshake(message: Message) -> bool:
    return bool(message.get_type() == "DATA_TRANSMISSION_HANDSHAKE")


def _is_echo(message: Message) -> bool:
    """The dock's answer to an announced frame: yes or no."""
    refused = message.get_type() == "STATUSTEXT" and message.text.startswith("injection refused")
    return refused or _is_handshake(message)


def _is_outcome(before: int, message: Message) -> bool:
    """What became of an injected frame."""
    if message.get_type() == "DOCK_STATUS":
        return bool(message.frames > before)
    return bool(
        message.get_type() == "STATUSTEXT" and message.text.startswith("injected frame dropped")
    )
