"""A dock at a wire, with what tests do to it beyond what the host package offers."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any

from targets import Target
from wire import ROM_BAUD, Wire

from chromadock import dialect
from chromadock.link import DockClient
from chromadock.link.commands import command_long
from chromadock.link.messenger import DOCK_COMPONENT, DOCK_SYSTEM

Message = Any
BOOT_LINE = re.compile(rb"rst:(0x\w+) \((\w+)\),boot:0x(\w+) \((\w+)\)")
ROM_END = b"entry 0x"
BAD_TEXT = re.compile(
    rb"Brownout|Guru Meditation|flash read err|DOWNLOAD_BOOT|abort\(\)|Backtrace:|WDT_RESET"
)
REBOOT = dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN
FULL = 4096
"""A duty of all of the time."""
DARK = [0, 0, 0]


class Rig:
    """The wire, the dock behind it, and all that it said since ``forget``."""

    def __init__(self, target: Target, wire: Wire) -> None:
        self.target = target
        self.wire = wire
        self.raw = bytearray()
        self._leave = wire.listen(self.raw.extend)
        self.texts: list[str] = []
        self.dock = DockClient(
            wire,  # type: ignore[arg-type]  # a Connection to all that uses it
            timeout_s=target.boot_s,
            on_text=lambda _, words: self.texts.append(words),
        )
        self.messenger = self.dock.messenger

    def forget(self) -> None:
        """Drop what was heard so far."""
        while self.messenger.receive(0.0) is not None:
            pass
        self.texts.clear()
        self.raw.clear()

    def defaults(self) -> None:
        """Default parameters and automatic colours, from the camera; not in flash.

        The limit and the polarity, which a reset leaves, are those of the golden duties.
        """
        self.send(handshake(0, 0, 0, 0, 0))
        self.dock.reset()
        self.dock.set_parameter("LED_LIMIT", 255)
        self.dock.set_parameter("LED_ANODE", 0)
        self.dock.led_auto()
        if self.wire.baud != 921600:  # or a saved default would lose the board
            self.dock.set_parameter("LINK_BAUD", self.wire.baud)
        self.forget()

    def send(self, *messages: Message) -> None:
        """Messages of the dialect, in one piece."""
        self.wire.write(b"".join(map(self.pack, messages)))

    def pack(self, message: Message, system: int = 255, component: int = 190) -> bytes:
        """A message's bytes, from any sender."""
        return bytes(message.pack(dialect.MAVLink(None, system, component)))

    def wait(
        self, kind: str, what: Callable[[Message], bool] = lambda m: True, timeout_s: float = 5.0
    ) -> Message:
        """The next message of a kind that ``what`` accepts; fails the test without one."""
        message = self.messenger.wait(lambda m: bool(m.get_type() == kind and what(m)), timeout_s)
        assert message is not None, f"no such {kind} within {timeout_s:g} s"
        return message

    def heard_until(self, last: Callable[[Message], bool], timeout_s: float = 5.0) -> list[Message]:
        """All messages up to the one that ``last`` accepts."""
        heard: list[Message] = []
        end = time.monotonic() + timeout_s
        while not heard or not last(heard[-1]):
            message = self.messenger.receive(max(end - time.monotonic(), 0.0))
            assert message is not None, f"only {[m.get_type() for m in heard]}"
            heard.append(message)
        return heard

    def command(self, number: int, *values: float) -> int:
        """The last result of a command."""
        self.send(command_long(number, *values))

        def last(ack: Message) -> bool:
            return bool(ack.command == number and ack.result != dialect.MAV_RESULT_IN_PROGRESS)

        return int(self.wait("COMMAND_ACK", last).result)

    def status(self, wanted: Callable[[Message], bool], timeout_s: float = 5.0) -> Message:
        """The first DOCK_STATUS that ``wanted`` accepts, asked for again and again."""
        end = time.monotonic() + timeout_s
        while True:
            status = self.dock.status()
            if wanted(status):
                return status
            assert time.monotonic() < end, f"still {status}"

    def text(self, part: str, timeout_s: float = 5.0) -> str:
        """The status text with ``part`` in it: one of those heard, or the next."""
        end = time.monotonic() + timeout_s
        while not (found := [t for t in self.texts if part in t]):
            left = end - time.monotonic()
            assert left > 0, f"no text with {part!r}, only {self.texts}"
            self.messenger.receive(left)
        return found[0]

    def reset(self) -> re.Match[bytes]:
        """Reset and wait for the boot line, which is returned."""
        if not self.target.is_board:
            return self.reboot()
        self.forget()
        self.wire.speed(ROM_BAUD)
        self.wire.pulse_reset()
        return self._boot_line()

    def reboot(self) -> re.Match[bytes]:
        """Restart by command and wait for the boot line, which is returned."""
        self.forget()
        assert self.command(REBOOT, 1) == dialect.MAV_RESULT_ACCEPTED
        if self.target.is_board:
            self.wire.speed(ROM_BAUD)
        return self._boot_line()

    def alive(self) -> None:
        """Wait for the dock's greeting and its first colour; nothing bad was printed."""
        self.text("Chromadock", self.target.boot_s)
        self.status(lambda s: s.frames > 0, self.target.boot_s)
        self.healthy()

    def healthy(self) -> None:
        """Fail for a crash, a brownout or another reset since ``forget``."""
        bad = BAD_TEXT.search(self.raw)
        assert bad is None, f"the dock printed {bad and bad[0]!r}"
        assert self.raw.count(b"rst:0x") <= 1, "it restarted once more by itself"

    def leds_off(self) -> None:
        """Dark until the next command or restart; checked."""
        self.send(handshake(0, 0, 0, 0, 0))
        self.dock.led_raw(0, 0, 0)
        anode = self.dock.parameter("LED_ANODE")
        assert self.dock.status().duty == ([FULL] * 3 if anode else DARK)

    def close(self) -> None:
        """Listen no more; the wire stays open."""
        self._leave()

    def _boot_line(self) -> re.Match[bytes]:
        end = time.monotonic() + self.target.boot_s
        try:
            while ROM_END not in self.raw:
                left = end - time.monotonic()
                assert left > 0, f"no boot text, only {bytes(self.raw[-200:])!r}"
                self.messenger.receive(min(left, 0.05))
        finally:
            self.wire.speed(self.wire.baud)
        line = BOOT_LINE.search(bytes(self.raw))
        assert line is not None, f"no boot line in {bytes(self.raw)!r}"
        return line


def handshake(kind: int, size: int, width: int, height: int, packets: int) -> Message:
    """The announcement of a picture; one of size 0 ends injection."""
    return dialect.MAVLink_data_transmission_handshake_message(
        kind, size, width, height, packets, 253, 0
    )


def parameter_set(
    name: str, value: float, system: int = DOCK_SYSTEM, component: int = DOCK_COMPONENT
) -> Message:
    """PARAM_SET to any address."""
    return dialect.MAVLink_param_set_message(
        system, component, name.encode(), value, dialect.MAV_PARAM_TYPE_REAL32
    )


def parameter_read(
    name: str, system: int = DOCK_SYSTEM, component: int = DOCK_COMPONENT
) -> Message:
    """PARAM_REQUEST_READ to any address."""
    return dialect.MAVLink_param_request_read_message(system, component, name.encode(), -1)
