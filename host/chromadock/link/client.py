"""One dock at the other end of a connection, checked to be of this program's method."""

from __future__ import annotations

import time
from dataclasses import dataclass

from chromadock import dialect, method
from chromadock.closable import Closable
from chromadock.errors import ChromadockError
from chromadock.link import parameters, pictures
from chromadock.link.commands import ask_for_message, command, command_long
from chromadock.link.connection import Connection
from chromadock.link.framing import Message
from chromadock.link.messenger import AGAIN_S, PATIENCE_S, Clock, Messenger, OnText

REBOOT_TIMEOUT_S = 10.0
_OTHERS_S = 0.05
_ONCE_DAMAGED = 3
"""Messages that may be damaged on the way before it looks like more than chance."""
_STORE, _STORE_SAVE, _STORE_RESET = dialect.MAV_CMD_PREFLIGHT_STORAGE, 1, 2
_REBOOT, _REBOOT_NOW = dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1


@dataclass(frozen=True)
class Version:
    """``git_hash``: first letters of the firmware's commit; ``method_digest``: 16
    hexadecimal digits, equal to ``method.DIGEST`` where both decide alike; ``uid``: the chip's
    number, 0 where the dock does not tell it."""

    git_hash: str
    method_digest: str
    uid: int


class DockClient(Closable):
    """Talks to the dock behind ``connection``, which it owns from now on.

    Parameters
    ----------
    timeout_s
        For the version, and for every other answer.
    on_text
        Gets severity and words of every status text.
    system
        The dock's MAVLink system, its SYSTEM_ID; None: of the only dock there.

    Raises
    ------
    ChromadockError
        One line: nobody answers, several docks, other firmware, another method digest.
    """

    def __init__(
        self,
        connection: Connection,
        timeout_s: float = PATIENCE_S,
        clock: Clock = time.monotonic,
        on_text: OnText | None = None,
        system: int | None = None,
    ) -> None:
        self.connection = connection
        self.messenger = Messenger(connection, timeout_s, clock, on_text, system)
        try:
            self.version = _greet(self.messenger, timeout_s)
        except BaseException:
            connection.close()
            raise

    @property
    def name(self) -> str:
        """What to call the dock: by its MAVLink system, ``dock 50``."""
        return f"dock {self.messenger.system}"

    def status(self) -> Message:
        """A DOCK_STATUS of now."""
        number = dialect.MAVLINK_MSG_ID_DOCK_STATUS
        try:
            return ask_for_message(self.messenger, number, "DOCK_STATUS")
        except ChromadockError:
            self.check_dialect()
            raise

    def request_status(self) -> None:
        """Ask for a DOCK_STATUS, for ``next_status`` to return."""
        self.messenger.send(
            command_long(dialect.MAV_CMD_REQUEST_MESSAGE, dialect.MAVLINK_MSG_ID_DOCK_STATUS)
        )

    def next_status(self, timeout_s: float) -> Message | None:
        """The next DOCK_STATUS that the dock sends by itself or on request, or None."""
        return self.messenger.wait(lambda m: bool(m.get_type() == "DOCK_STATUS"), timeout_s)

    def check_dialect(self) -> None:
        """For when no DOCK_STATUS comes.

        Raises
        ------
        ChromadockError
            Where they do come, but none that this program can read.
        """
        number = dialect.MAVLINK_MSG_ID_DOCK_STATUS
        wrong = self.messenger.finder.rejected[number]
        if wrong > _ONCE_DAMAGED and not self.messenger.received[number]:
            raise ChromadockError(
                f"{self.connection.url}: the dock's DOCK_STATUS has another layout: flash this "
                "version's firmware with `chromadock dock flash`"
            )

    def parameters(self) -> dict[str, float]:
        """Every parameter by name, in the dock's order."""
        return parameters.fetch_all(self.messenger)

    def parameter(self, name: str) -> float:
        """One parameter, see ``link.values.TABLE`` for names and units."""
        return parameters.fetch(self.messenger, name)

    def set_parameter(self, name: str, value: float) -> float:
        """Set it; returns the dock's nearest step to ``value``."""
        return parameters.assign(self.messenger, name, value)

    def save(self) -> None:
        """Write the parameters to the dock's flash: they outlast a restart."""
        command(self.messenger, _STORE, "saving the parameters", _STORE_SAVE)

    def reset(self) -> None:
        """Every parameter at its default; not in flash until ``save``."""
        command(self.messenger, _STORE, "resetting the parameters", _STORE_RESET)

    def led_auto(self) -> None:
        """The LEDs show the marker colour for this water."""
        command(self.messenger, dialect.MAV_CMD_DOCK_LED, "led auto", dialect.DOCK_LED_AUTO)

    def led_hue(self, degrees: float) -> None:
        """The LEDs show this hue, 0..360 degrees, corrected like a marker colour."""
        number, mode = dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_HUE
        command(self.messenger, number, f"led {degrees:g}", mode, degrees)

    def led_raw(self, red: int, green: int, blue: int) -> None:
        """The LEDs show these duties, 0..255, without correction."""
        number, mode = dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_RAW
        what = f"led {red} {green} {blue}"
        command(self.messenger, number, what, mode, red, green, blue)

    def snapshot(self) -> tuple[bytes, int, int]:
        """The next camera frame: RGB565 bytes (see ``link.rgb565``), width, height."""
        return pictures.snapshot(self.messenger)

    def inject(self, data: bytes, width: int, height: int, kind: int = pictures.RGB565) -> Message:
        """Let the dock decide on this frame; the DOCK_STATUS after it.

        See ``link.pictures.inject``.
        """
        return pictures.inject(self.messenger, data, width, height, kind)

    def end_injection(self) -> None:
        """Give the dock its camera back."""
        pictures.end_injection(self.messenger)

    def reboot(self) -> None:
        """Restart the dock and wait until it is back.

        Raises
        ------
        ChromadockError
            Where it refuses, or is not back within ten seconds.
        """
        before = self.status().time_boot_ms

        def restarted(message: Message) -> bool:
            # Its clock tells less if it was restarted just before.
            if message.get_type() == "STATUSTEXT":
                return " started, reset reason" in message.text
            return bool(message.get_type() == "DOCK_STATUS" and message.time_boot_ms < before)

        command(self.messenger, _REBOOT, "reboot", _REBOOT_NOW)
        end = self.messenger.clock() + REBOOT_TIMEOUT_S
        while self.messenger.clock() < end:
            self.request_status()
            if self.messenger.wait(restarted, AGAIN_S) is not None:
                return
        raise self.messenger.silent("anything after its reboot")

    def close(self) -> None:
        """Let go of the port."""
        self.connection.close()


def _greet(messenger: Messenger, timeout_s: float) -> Version:
    """Ask for the version until it comes: sooner than a heartbeat, and it says more.

    A heartbeat is asked for as well where it tells which system is a dock.
    """
    url = messenger.connection.url
    end = messenger.clock() + timeout_s
    ask, found = dialect.MAV_CMD_REQUEST_MESSAGE, messenger.system is not None
    answer = None
    while answer is None:
        if not found:
            messenger.send(command_long(ask, dialect.MAVLINK_MSG_ID_HEARTBEAT))
        messenger.send(command_long(ask, dialect.MAVLINK_MSG_ID_AUTOPILOT_VERSION))
        wait_s = min(AGAIN_S, max(end - messenger.clock(), 0.0))
        answer = messenger.wait(lambda m: bool(m.get_type() == "AUTOPILOT_VERSION"), wait_s)
        if answer is None and messenger.clock() >= end:
            raise _nobody(messenger, timeout_s)
    if not found:
        _choose(messenger, answer.get_srcSystem())
    version = Version(
        bytes(answer.flight_custom_version).rstrip(b"\0").decode("ascii", "replace"),
        bytes(reversed(answer.middleware_custom_version)).hex(),
        answer.uid,
    )
    if version.method_digest != method.DIGEST:
        raise ChromadockError(
            f"{url}: the dock's method is {version.method_digest}, this program's "
            f"{method.DIGEST}, so their colours would differ: flash the dock with "
            "`chromadock dock flash`, or install its version of chromadock here"
        )
    return version


def _choose(messenger: Messenger, system: int) -> None:
    """Talk to this dock from now on, if there is no other."""
    # All were asked at once: another one's answer is not far behind.
    messenger.wait(lambda m: bool(m.get_srcSystem() != system), _OTHERS_S)
    if len(messenger.docks) > 1:
        systems = ", ".join(map(str, sorted(messenger.docks)))
        raise ChromadockError(
            f"{messenger.connection.url}: several docks, systems {systems}: "
            "choose one with --system"
        )
    messenger.system = system


def _nobody(messenger: Messenger, timeout_s: float) -> ChromadockError:
    url = messenger.connection.url
    if messenger.heartbeats:
        return ChromadockError(
            f"{url}: a dock's heartbeat, but no version: "
            "flash this version's firmware with `chromadock dock flash`"
        )
    if messenger.docks:
        systems = ", ".join(map(str, sorted(messenger.docks)))
        return ChromadockError(
            f"{url}: a dock of system {systems} is there, but not {messenger.system}: "
            "give another --system, or none"
        )
    if messenger.strangers:
        systems = ", ".join(map(str, sorted(messenger.strangers)))
        return ChromadockError(
            f"{url}: MAVLink system {systems} is there, but no dock: give the dock's --port"
        )
    if messenger.bytes_received:
        return ChromadockError(
            f"{url}: sends bytes, but no dock's heartbeat: it runs other firmware or at another "
            "speed, so try --baud, or flash it with `chromadock dock flash`"
        )
    return ChromadockError(
        f"{url}: silent for {timeout_s:g} s: check power and cable, or give another --port"
    )
