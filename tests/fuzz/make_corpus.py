"""Writes tests/fuzz/corpus: .venv/bin/python tests/fuzz/make_corpus.py.

Each file is a list of steps as fuzz_receive.c reads them; the raw ones hold messages that
pymavlink packed.
"""

from __future__ import annotations

import shutil
import struct
from pathlib import Path

from chromadock import dialect as mavlink

CORPUS = Path(__file__).parent / "corpus"
RAW, MESSAGE, WAIT, SEND, CAMERA, BOARD, LOCK, FLUSH = range(8)
LIST, READ, SET, COMMAND, HANDSHAKE, PACKET, UNKNOWN, PLACE, TYPED_LIST, TYPED_READ, TYPED_SET = (
    range(11)
)
GOOD, BAD_CHECKSUM, TO_ANOTHER, FROM_THE_DOCK = 0, 4, 5, 6
SIGNED, UNCUT, PLAUSIBLE, ALONE = 0x08, 0x10, 0x20, 0x40
DOCK = (mavlink.DOCK_ID_SYSTEM, mavlink.DOCK_ID_COMPONENT)
STORAGE, REBOOT = mavlink.MAV_CMD_PREFLIGHT_STORAGE, mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN


def raw(data: bytes) -> bytes:
    """Steps with the host's bytes as they are."""
    pieces = [data[i : i + 200] for i in range(0, len(data), 200)]
    return b"".join(bytes([RAW, len(piece)]) + piece for piece in pieces)


def message(kind: int, manner: int, payload: bytes, piece: int = 0) -> bytes:
    """A step with a message that the harness frames."""
    return bytes([MESSAGE, kind, manner, piece, len(payload)]) + payload


def send(capacity: int = 4095) -> bytes:
    """A step that takes what the dock has to say."""
    return bytes([SEND]) + capacity.to_bytes(2, "little")


def wait(ms: int) -> bytes:
    """A step of silence."""
    return bytes([WAIT]) + ms.to_bytes(2, "little")


def frame(kind: int, red: int, green: int, blue: int) -> bytes:
    """A step with a camera frame; kind 3 is a camera fault."""
    return bytes([CAMERA, kind, red, green, blue])


class Host:
    """Packs messages as pymavlink does."""

    def __init__(self, *, signed: bool = False) -> None:
        self.link = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
        if signed:
            self.link.signing.secret_key = bytes(range(32))
            self.link.signing.sign_outgoing = True
            self.link.signing.timestamp = 1

    def command(self, command: int, *arguments: float, target: tuple[int, int] = DOCK) -> bytes:
        """A COMMAND_LONG with up to seven arguments."""
        seven = [*arguments, *[0.0] * (7 - len(arguments))]
        return self.pack(mavlink.MAVLink_command_long_message(*target, command, 0, *seven))

    def set(self, name: str, value: float, target: tuple[int, int] = DOCK) -> bytes:
        """A PARAM_SET."""
        real = mavlink.MAV_PARAM_TYPE_REAL32
        return self.pack(
            mavlink.MAVLink_param_set_message(*target, name.encode("ascii"), value, real)
        )

    def integer(self, name: str, value: int, kind: int) -> bytes:
        """A PARAM_SET with an integer's own bytes."""
        (number,) = struct.unpack("<f", (value & 0xFFFFFFFF).to_bytes(4, "little"))
        return self.pack(
            mavlink.MAVLink_param_set_message(*DOCK, name.encode("ascii"), number, kind)
        )

    def pack_1(self, one: mavlink.MAVLink_message) -> bytes:
        """Any message's bytes in MAVLink 1."""
        return bytes(one.pack(self.link, force_mavlink1=True))

    def pack(self, one: mavlink.MAVLink_message) -> bytes:
        """Any message's bytes."""
        return bytes(one.pack(self.link))


def entries() -> dict[str, bytes]:
    """Every file of the corpus by its name, less the first byte, which sets the clock."""
    host, signed = Host(), Host(signed=True)
    led = mavlink.MAV_CMD_DOCK_LED
    listing = host.pack(mavlink.MAVLink_param_request_list_message(*DOCK))
    read = host.pack(mavlink.MAVLink_param_request_read_message(*DOCK, b"LED_HUE", -1))
    heartbeat = host.pack(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3))
    text = b"\r\nE (1234) cam_hal: FB-OVF \xfd\xfd\r\n"
    limit = host.set("LED_LIMIT", 7)
    packets = b"".join(
        message(PACKET, PLAUSIBLE, bytes([0, 0, *[n] * 250])) for n in (10, 80, 200, 30)
    )
    announced = message(HANDSHAKE, PLAUSIBLE | ALONE, bytes([1, 31, 9, 0]))
    tunnel = mavlink.MAVLink_tunnel_message(1, 1, 0, 45, [*limit.ljust(128, b"\0")])
    request_list = mavlink.MAVLink_param_request_list_message(*DOCK)
    list_1 = host.pack_1(request_list)
    typed = b"\x32\1LED_LIMIT" + bytes(7) + b"\x80" + bytes(127)
    interval = mavlink.MAV_CMD_SET_MESSAGE_INTERVAL
    snapshot = message(COMMAND, PLAUSIBLE, bytes([0] * 28 + [1, 0]))
    return {
        "list": raw(listing) + send(100) + send(),
        "read": raw(read) + raw(heartbeat) + send(),
        "set": b"".join(
            raw(host.set(name, value)) + send()
            for name, value in (
                ("LED_M_RG", -0.5), ("CAM_GAIN", 31), ("REPORT_HZ", 30), ("FALLBACK_HUE", 359.8),
                ("LED_LIMIT", float("nan")), ("NO_SUCH_NAME_16_", 1), ("LINK_BAUD", 9600),
            )
        ),
        "set_checked": b"".join(
            message(SET, PLAUSIBLE | ALONE, b"\0\0\x20\x41\0\0" + bytes([n])) for n in range(27)
        ),
        "others": raw(host.set("LED_LIMIT", 7, (51, 1))) + raw(host.set("LED_LIMIT", 7, (0, 0))),
        "inert": b"".join(
            message(SET, manner | PLAUSIBLE, b"\0\0\x20\x41\0\0\x12")
            + message(COMMAND, manner | PLAUSIBLE, b"\2\xff\1\1" + bytes(24))
            + message(HANDSHAKE, manner | PLAUSIBLE, b"\1\3\3\0")
            + message(SET, manner, list_1)
            for manner in (BAD_CHECKSUM, TO_ANOTHER, FROM_THE_DOCK)
        ),
        "leds": frame(0, 0, 0, 200) + raw(host.command(led, 2, 255, 0, 9)) + send()
        + raw(host.command(led, 1, 360)) + raw(host.command(led, 1, 361))
        + raw(host.command(led, 0)) + send(),
        "save": raw(host.command(STORAGE, 1)) + bytes([BOARD, 1]) + send() + bytes([BOARD, 0])
        + raw(host.command(STORAGE, 1)) + bytes([BOARD, 0]) + send() + raw(host.command(STORAGE, 2))
        + bytes([BOARD, 0]) + send(),
        "reboot": raw(host.command(REBOOT, 1)) + bytes([BOARD, 0]) + send(20) + send()
        + bytes([BOARD, 0]),
        "unsupported": raw(host.command(22, 1)) * 5 + send(),
        "version": raw(host.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 148)) + send(60) + send(),
        "snapshot": snapshot + frame(0, 1, 2, 3) + send(300) + snapshot + send()
        + frame(4, 1, 2, 3) + send(),
        "snapshot_or_inject": snapshot + frame(0, 9, 9, 9) + announced + packets + send(),
        "inject": announced + send() + packets + send() + frame(0, 200, 0, 0) + wait(3001)
        + frame(0, 200, 0, 0),
        "inject_full": message(HANDSHAKE, PLAUSIBLE, bytes([0, 31, 31, 0])) + send()
        + message(PACKET, PLAUSIBLE, b"") * 13 + send(),
        "inject_wrong": message(HANDSHAKE, PLAUSIBLE, bytes([0, 3, 3, 254])) + packets + send(),
        "inject_lost": announced + packets[:256] + message(PACKET, 0, b"\3\0" + b"x" * 100) + send()
        + message(HANDSHAKE, PLAUSIBLE, b"\1\3\3\xff") + frame(0, 0, 200, 0),
        "camera": frame(0, 0, 0, 200) + frame(3, 0, 0, 0) * 3 + send() + frame(1, 0, 0, 0)
        + frame(0, 0, 200, 0) + send() + wait(10000) + frame(2, 0, 200, 0) + send(),
        "lock": bytes([LOCK, 44, 1, 7, 0]) + send() + wait(1000) + send(),
        "signed": raw(signed.set("LED_LIMIT", 7)) + raw(signed.command(led, 2, 1, 2, 3)) + send(),
        "noise": raw(text + limit + text) + wait(201) + raw(limit[:20]) + raw(limit) + wait(201)
        + raw(b"\xfd" * 280) + raw(limit) + bytes([FLUSH]) + send(),
        "carried": raw(host.pack(tunnel)) + bytes([FLUSH]) + send()
        + raw(b"\xfd\x23\0\0\1\1\1\x0c\x2b\0" + limit + b"\0\0" + read) + send(),
        "version_1": raw(list_1) + raw(list_1[:5]) + raw(read) + send(),
        "integers": b"".join(raw(host.integer(*three)) + send() for three in (
            ("LED_LIMIT", 128, 6), ("CAM_GAIN", -1, 2), ("CAM_GAIN", 0xFF, 2),
            ("WINDOW_MS", 1500, 3), ("LED_LIMIT", 128, 9), ("LINK_BAUD", 9600, 5),
        )),
        "typed": message(TYPED_LIST, 0, b"\x32\1") + send(200)
        + message(TYPED_READ, 0, b"\3\0\x32\1") + message(TYPED_SET, 0, typed + b"\6") + send()
        + message(TYPED_SET, 0, typed + b"\x0b") + send(),
        "place": message(PLACE, 0, b"\0\0\0\x40" + bytes(24) + b"\x9c\x7c") + send(),
        "intervals": raw(host.command(interval, 42500, 1e5)) + wait(100) + send()
        + raw(host.command(mavlink.MAV_CMD_GET_MESSAGE_INTERVAL, 42500)) + send()
        + raw(host.command(interval, 0, -1)) + send(),
        "snapshot_again": snapshot + frame(0, 1, 2, 3) + send()
        + raw(host.command(mavlink.MAV_CMD_DOCK_SNAPSHOT, 1, 0, 1)) + send(300) + send()
        + snapshot + wait(5001) + frame(0, 1, 2, 3) + send(),
        "led_limit_in_time": raw(host.command(led, 2, 9, 9, 9)) + wait(65535) * 10 + send(),
        "broadcast": raw(host.command(REBOOT, 1, target=(0, 0))) + bytes([BOARD, 0]) + send(),
        "pieces": b"".join(message(LIST, UNCUT, b"", n) + send(60) for n in (1, 3, 13)),
        "wrap": (wait(900) + send(200)) * 6,
        "unknown": message(UNKNOWN, SIGNED, b"\1\2\3") + raw(heartbeat) + send(),
    }  # fmt: skip


def main() -> None:
    """Write them all anew."""
    shutil.rmtree(CORPUS, ignore_errors=True)
    CORPUS.mkdir()
    for number, (name, steps) in enumerate(entries().items()):
        (CORPUS / name).write_bytes(bytes([number % 2]) + steps)


if __name__ == "__main__":
    main()
