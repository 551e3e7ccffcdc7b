"""Camera frames over the link: a snapshot from the dock, a frame injected into it."""

from __future__ import annotations

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
_QUIET_S = 0.5


def snapshot(messenger: Messenger) -> tuple[bytes, int, int]:
    """The next camera frame: RGB565 bytes, width, height.

    Raises
    ------
    ChromadockError
        Where no whole frame comes in several tries.
    """
    lost = ""
    for _ in range(_TRIES):
        command(messenger, dialect.MAV_CMD_DOCK_SNAPSHOT, "a snapshot")
        start = messenger.wait(_is_handshake, messenger.patience_s)
        if start is None:
            raise ChromadockError(
                f"{messenger.connection.url}: the dock's camera gives no frame within "
                f"{messenger.patience_s:g} s: see `chromadock dock watch`, or wait longer with "
                "--timeout"
            )
        packets = _packets(messenger, start.packets)
        if len(packets) == start.packets and start.size == 2 * start.width * start.height:
            data = b"".join(packets[i] for i in range(start.packets))
            return data[: start.size], start.width, start.height
        lost = f"{start.packets - len(packets)} of {start.packets} packets were lost"
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


def _packets(messenger: Messenger, count: int) -> dict[int, bytes]:
    packets: dict[int, bytes] = {}
    while len(packets) < count:
        message = messenger.wait(lambda m: bool(m.get_type() == "ENCAPSULATED_DATA"), _QUIET_S)
        if message is None:
            break
        if message.seqnr < count:
            packets[message.seqnr] = bytes(message.data)
        if message.seqnr == count - 1:
            break
    return packets


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
