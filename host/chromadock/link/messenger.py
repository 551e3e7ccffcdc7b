"""Messages to and from one dock: sending, waiting, the host's own heartbeat."""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Callable
from typing import Any

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link.connection import Connection
from chromadock.link.framing import FrameFinder, Message

HOST_SYSTEM = 255
HOST_COMPONENT = dialect.MAV_COMP_ID_MISSIONPLANNER
DOCK_SYSTEM = dialect.DOCK_ID_SYSTEM
DOCK_COMPONENT = dialect.DOCK_ID_COMPONENT
EVERY_SYSTEM = 0

PATIENCE_S = 2.0
"""For an answer; with the start of the program it makes 3 s."""
AGAIN_S = 0.4
"""After so long without an answer the request or the answer was lost."""
HEARTBEAT_PERIOD_S = 1.0
SILENCE_S = 0.05
"""With no byte for so long an unfinished message will stay unfinished: messages come in
one go, and a USB adapter holds them back for 16 ms at most."""

Clock = Callable[[], float]
OnText = Callable[[int, str], None]
"""Takes severity and words of a STATUSTEXT."""


class Messenger:
    """One dock's messages over ``connection``; ``clock`` gives seconds, and ``patience_s`` is
    the longest wait for an answer, with all repetitions.

    ``system`` is the dock's MAVLink system.  None: not known yet; what is sent goes to all of
    them, and what comes from any dock is taken.

    Attributes
    ----------
    finder
        The receiver with its counts.
    bytes_received
        All that came, whatever it was.
    heartbeats
        Of the dock.
    received
        Messages of the dock, by id.
    docks
        Systems of docks that were heard, whichever one is talked to.
    strangers
        System ids of other MAVLink systems that were heard.
    last_text
        The newest status text of the dock, or "".
    """

    def __init__(
        self,
        connection: Connection,
        patience_s: float = PATIENCE_S,
        clock: Clock = time.monotonic,
        on_text: OnText | None = None,
        system: int | None = DOCK_SYSTEM,
    ) -> None:
        self.connection = connection
        self.system = system
        self.patience_s = patience_s
        self.clock = clock
        self.on_text = on_text
        self.finder = FrameFinder()
        self.bytes_received = 0
        self.heartbeats = 0
        self.received: Counter[int] = Counter()
        self.docks: set[int] = set()
        self.strangers: set[int] = set()
        self.last_text = ""
        self._mav: Any = dialect.MAVLink(None, HOST_SYSTEM, HOST_COMPONENT)
        self._queue: deque[Message] = deque()
        self._heartbeat_due = clock()
        self._last_byte = clock()

    def send(self, message: Message) -> None:
        """Send a message of the dialect; one to a dock of the default system goes to this one."""
        if getattr(message, "target_system", None) == DOCK_SYSTEM:
            message.target_system = EVERY_SYSTEM if self.system is None else self.system
        data = message.pack(self._mav)
        self._mav.seq = (self._mav.seq + 1) % 256
        self.connection.write(data)

    def receive(self, timeout_s: float) -> Message | None:
        """The dock's next message, or None after ``timeout_s`` seconds."""
        end = self.clock() + timeout_s
        while True:
            if self._queue:
                return self._queue.popleft()
            now = self.clock()
            if now >= self._heartbeat_due:
                self._heartbeat_due = now + HEARTBEAT_PERIOD_S
                self._send_heartbeat()
            data = self.connection.read(min(end - now, self._heartbeat_due - now, SILENCE_S))
            self._take(data)
            if not self._queue and self.clock() >= end:
                return None

    def wait(self, wanted: Callable[[Message], bool], timeout_s: float) -> Message | None:
        """The first message that ``wanted`` accepts, or None; others are passed over."""
        end = self.clock() + timeout_s
        while (message := self.receive(max(end - self.clock(), 0.0))) is not None:
            if wanted(message):
                return message
            if self.clock() >= end and not self._queue:
                break
        return None

    def ask(self, request: Message, wanted: Callable[[Message], bool], what: str) -> Message:
        """Send ``request`` again and again until an answer comes, for ``patience_s``.

        Raises
        ------
        ChromadockError
            Where none does; ``what`` says what was asked for.
        """
        end = self.clock() + self.patience_s
        while (left_s := end - self.clock()) > 0:
            self.send(request)
            answer = self.wait(wanted, min(AGAIN_S, left_s))
            if answer is not None:
                return answer
        raise self.silent(what)

    def silent(self, what: str) -> ChromadockError:
        """The error for a dock that did not answer."""
        said = f' (it last said "{self.last_text}")' if self.last_text else ""
        return ChromadockError(
            f"{self.connection.url}: the dock did not answer to {what}{said}: "
            "check cable and power, or wait longer with --timeout"
        )

    def _send_heartbeat(self) -> None:
        self.send(
            dialect.MAVLink_heartbeat_message(
                dialect.MAV_TYPE_GCS,
                dialect.MAV_AUTOPILOT_INVALID,
                0,
                0,
                dialect.MAV_STATE_ACTIVE,
                3,
            )
        )

    def _take(self, data: bytes) -> None:
        now = self.clock()
        if data:
            self.bytes_received += len(data)
            self._last_byte = now
            found = self.finder.feed(data)
        elif now - self._last_byte >= SILENCE_S:
            found = self.finder.give_up()
        else:
            return
        for message in found:
            self._sort(message)

    def _sort(self, message: Message) -> None:
        system = message.get_srcSystem()
        if message.get_srcComponent() == DOCK_COMPONENT and _is_docks(message):
            self.docks.add(system)
        ours = self.docks if self.system is None else {self.system}
        if system not in ours or message.get_srcComponent() != DOCK_COMPONENT:
            self.strangers.add(system)
            return
        self.received[message.get_msgId()] += 1
        kind = message.get_type()
        if kind == "HEARTBEAT":
            self.heartbeats += 1
        elif kind == "STATUSTEXT":
            self.last_text = message.text.rstrip("\0")
            if self.on_text is not None:
                self.on_text(message.severity, self.last_text)
        self._queue.append(message)


def _is_docks(message: Message) -> bool:
    """Whether only a dock sends such a message: by the default system, by what its heartbeat
    says it is, or because no one else has it."""
    kind = message.get_type()
    if kind == "HEARTBEAT" and message.get_srcSystem() != DOCK_SYSTEM:
        return bool(
            message.type == dialect.MAV_TYPE_GENERIC
            and message.autopilot == dialect.MAV_AUTOPILOT_GENERIC
        )
    return bool(kind == "DOCK_STATUS" or message.get_srcSystem() == DOCK_SYSTEM)
