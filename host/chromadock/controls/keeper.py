"""Keeps a camera set as the user wants it, each time that its source has been opened."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from chromadock.back_off import FIRST_RETRY_S, LONGEST_RETRY_S
from chromadock.controls.applying import Held, Wishes, apply
from chromadock.controls.base import Controls, ControlsAwayError

FIRST_S = 1.0
"""How long opening a source waits for the first setting, so that it is there before the first
picture; a camera or a manager that hangs does not keep the pictures back for longer."""


SETTLE_S = 2.0
"""After the first picture, until the camera's automatics have found what is to be locked."""


class _Session:
    """One time that the source is open."""

    def __init__(self) -> None:
        self.tried = threading.Event()
        self.seen = threading.Event()
        self.over = threading.Event()
        self.seen_s = 0.0
        """When its first picture came, on the monotonic clock."""


class Keeper:
    """Sets the controls of one camera in a thread of its own.

    They are set when the source has been opened, and again after its first picture, for some
    cameras forget them when they begin to send.  What the camera does not follow is told then, each
    line once, however often it is set anew.  What is to be locked is locked a while after the first
    picture of all; from then on it is set like any other value.

    Parameters
    ----------
    open_controls
        Reaches the camera; see ``ControlsAwayError``.
    wishes
        See there.
    name
        Of the source, for messages.
    tell
        Takes a line, from any thread.
    """

    def __init__(
        self,
        open_controls: Callable[[], Controls],
        wishes: Wishes,
        name: str,
        tell: Callable[[str], None],
    ) -> None:
        self._open = open_controls
        self._wishes = wishes
        self._name = name
        self._tell = tell
        self._held = Held()
        self._told: set[str] = set()
        self._one_at_a_time = threading.Lock()
        self._session = _Session()

    def opened(self) -> None:
        """The source has just been opened."""
        self._session = session = _Session()
        threading.Thread(
            target=self._keep, args=(session,), name=f"controls of {self._name}", daemon=True
        ).start()
        session.tried.wait(FIRST_S)

    def seen(self) -> None:
        """Its first picture came."""
        if not self._session.seen.is_set():
            self._session.seen_s = time.monotonic()
        self._session.seen.set()

    def lost(self) -> None:
        """It is closed."""
        self._session.over.set()
        self._session.seen.set()

    def _keep(self, session: _Session) -> None:
        """Set them before and after the first picture, however long that takes."""
        wait_s, away = FIRST_RETRY_S, False
        while not session.over.is_set():
            sending = session.seen.is_set()
            if sending and self._held.waits(self._wishes):
                session.over.wait(max(0.0, session.seen_s + SETTLE_S - time.monotonic()))
            try:
                with self._one_at_a_time, self._open() as controls:
                    lines = apply(controls, self._wishes, self._held, settled=sending)
            except ControlsAwayError as error:
                session.tried.set()
                if not session.over.is_set():
                    self._tell_once(f"camera controls are not set: {error}")
                away = True
                session.over.wait(wait_s)
                wait_s = min(2 * wait_s, LONGEST_RETRY_S)
                continue
            session.tried.set()
            if sending:
                for line in lines:
                    self._tell_once(line)
                if away:
                    self._tell(f"{self._name}: camera controls are set now")
                return
            session.seen.wait()

    def _tell_once(self, line: str) -> None:
        if line not in self._told:
            self._told.add(line)
            self._tell(f"{self._name}: {line}")
