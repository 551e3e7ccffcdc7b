"""The output to an autopilot: a thread beside the detection, which it never holds up."""

from __future__ import annotations

import contextlib
import os
import random
import select
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

import serial
from pymavlink.dialects.v20 import common as mavlink

from chromadock.autopilot.companion import COMPONENT, Companion, status_text
from chromadock.autopilot.frame_messages import frame_messages
from chromadock.autopilot.frame_times import FrameTimes
from chromadock.autopilot.landing_target import FORWARD, plnd_orient
from chromadock.autopilot.lock import Lock
from chromadock.autopilot.pace import Pace
from chromadock.autopilot.receivers import ROVER
from chromadock.autopilot.settings import AutopilotSettings
from chromadock.autopilot.transport import Transport
from chromadock.autopilot.wire import Message
from chromadock.back_off import FIRST_RETRY_S, LONGEST_RETRY_S
from chromadock.closable import Closable
from chromadock.mounting import Mounting, mounting_or_default
from chromadock.results.detection import Detection
from chromadock.results.track import Track
from chromadock.text import one_line
from chromadock.track.attitude import Attitude

Clock = Callable[[], float]
Tell = Callable[[str], None]

TICK_S = 0.1
"""Longest wait of the thread; it wakes at once for bytes and for messages."""

WAITING = 16
"""Messages that wait for the thread; older ones are dropped, for they are out of date."""

LATENCIES = 100
"""Frames of which the least delay is told."""

CLOSING_S = 2.0
"""For the thread to end."""


class AutopilotOutput(Closable):
    """Tells an autopilot of each frame; a context manager.

    Nothing here raises or waits because of a network or a port: what goes wrong is told once and
    tried again, and it is told when the vehicle is heard again.  ``attitude`` and ``write`` are for
    the thread that has the frames.

    Parameters
    ----------
    settings
        Where, to whom, how often.
    mounting
        How the camera sits in the vehicle: the same as the detector's.
    tell
        Gets lines for the user, also from the output's own thread.
    clock
        Monotonic seconds: of the frames' times, and of all times that are sent.
    """

    def __init__(
        self,
        settings: AutopilotSettings,
        mounting: Mounting | None,
        tell: Tell,
        clock: Clock = time.monotonic,
    ) -> None:
        self._settings = settings
        self._mounting = mounting_or_default(mounting)
        self._tell = tell
        self._clock = clock
        self._times = FrameTimes()
        self._pace = Pace(settings.rate_hz)
        # An autopilot that keeps running remembers the number of the run before.
        self._lock = Lock(reset_counter=random.randrange(256))
        self._newest_s: float | None = None
        self._latencies_s: deque[float] = deque(maxlen=LATENCIES)
        self._told: set[str] = set()
        orient = plnd_orient(settings.receiver, self._mounting)
        if settings.receiver is ROVER and orient != FORWARD:
            self._say(f"by the mounting of the camera the vehicle must have PLND_ORIENT {orient}")

        self._shared = threading.Lock()  # guards the next three
        first = settings.address.kind == "udpout"
        self._companion = Companion(settings.receiver, str(settings.address), clock(), first)
        self._outgoing: deque[Message] = deque(maxlen=WAITING)
        self._open = False

        self._closing = threading.Event()
        self._woken, self._wake = socket.socketpair()
        for end in (self._woken, self._wake):
            end.setblocking(False)
        self._thread = threading.Thread(target=self._run, name="autopilot", daemon=True)
        self._thread.start()

    def attitude(self, time_s: float, age_s: float | None = None) -> Attitude | None:
        """The vehicle's own at a frame's time, for ``Detector.process``; None while it is unknown.

        As for ``write``, but ``age_s`` by now.
        """
        ours_s = self._times.ours(time_s, self._clock(), age_s)
        with self._shared:
            return self._companion.telemetry.attitude(ours_s)

    def write(self, time_s: float, detection: Detection, age_s: float | None = None) -> None:
        """Tell of a frame.

        Parameters
        ----------
        time_s : when it was taken, seconds; of ``clock``, or of any that tells the age with it.
        detection : what the detector says of it.
        age_s : how old it is by now, seconds; None where nobody knows.  Times of another clock are
            mapped then, without the delay of the detection, which nobody can know.
        """
        track = detection.track
        if track is None:
            self._say_once(
                "there is no track, so nothing is sent: the detector treats frames alone"
            )
            return
        now_s = self._clock()
        ours_s = self._times.ours(time_s, now_s, age_s)
        if self._times.foreign:
            self._say_once(
                "the frames' times are not of this computer's monotonic clock: the vehicle is told "
                "when each arrived, and its attitude is of then"
            )
        self._latencies_s.append(now_s - ours_s)
        if self._is_told(track):
            return
        self._lock = self._lock.after(track)
        with self._shared:
            if not (self._open and self._companion.present(now_s)):
                return
            attitude = self._companion.telemetry.attitude(ours_s)
            position = self._companion.telemetry.position(ours_s)
        messages = self._announcement(track)
        if track.state == "tracking" and self._pace.take(ours_s):
            messages += frame_messages(
                self._settings.receiver,
                self._settings.vision,
                ours_s,
                track,
                self._mounting,
                attitude,
                position,
                self._lock.reset_counter,
            )
        if messages:
            with self._shared:
                self._outgoing += messages
            self._awake()

    @property
    def latency_s(self) -> float | None:
        """Least time from a frame to its message, of the newest hundred; None where it cannot be
        known.  ArduPilot cannot see it (``stamps``) and must be told by a parameter; PX4 can, by
        TIMESYNC."""
        if not self._latencies_s or self._times.foreign:
            return None
        return min(self._latencies_s)

    @property
    def heard(self) -> bool:
        """Whether the port is open and the vehicle's heartbeat came of late."""
        with self._shared:
            return self._open and self._companion.present(self._clock())

    def close(self) -> None:
        """End the thread and let go of the port."""
        if self._closing.is_set():
            return
        self._say_delay()
        self._closing.set()
        self._awake()
        self._thread.join(CLOSING_S)

    def _say_delay(self) -> None:
        """What ArduPilot's parameters for the delay should be, by this run."""
        latency_s, receiver = self.latency_s, self._settings.receiver
        if latency_s is None or receiver.autopilot != mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA:
            return
        names = [f"VISO_DELAY_MS {1000 * latency_s:.0f}"] if self._settings.vision else []
        names += [f"PLND_LAG {latency_s:.2f}"] if receiver.landing_target else []
        self._say(
            f"a frame is told of {1000 * latency_s:.0f} ms after it was taken or later: "
            f"the vehicle should have {' and '.join(names)}"
        )

    def _is_told(self, track: Track) -> bool:
        """Whether a frame is not newer than the newest: the track has not used it then."""
        newest_s, self._newest_s = self._newest_s, track.time_s
        return newest_s == track.time_s

    def _announcement(self, track: Track) -> list[Message]:
        self._lock, words = self._lock.announcing(track)
        return [] if words is None else [status_text(words)]

    def _awake(self) -> None:
        with contextlib.suppress(BlockingIOError):  # it has not even read the last one
            self._wake.send(b"!")

    def _run(self) -> None:
        """The thread: opens the address, again and again if need be, and serves it."""
        wait_s = FIRST_RETRY_S
        while not self._closing.is_set():
            try:
                with contextlib.closing(Transport(self._settings.address)) as transport:
                    self._serve(transport)
            except (OSError, ValueError) as error:  # a baud rate that a port has not
                with self._shared:
                    if self._companion.present(self._clock()):
                        wait_s = FIRST_RETRY_S
                    self._companion.failed(_reason(error), self._clock())
            finally:
                with self._shared:
                    self._open = False
                    self._outgoing.clear()
                    notices = self._notices()
            self._say_all(notices)
            self._closing.wait(wait_s)
            wait_s = min(2 * wait_s, LONGEST_RETRY_S)

    def _serve(self, transport: Transport) -> None:
        """Read, answer and send until the port fails or the output is closed."""
        parser = mavlink.MAVLink(None)
        parser.robust_parsing = True
        packer = mavlink.MAVLink(None, 0, COMPONENT)
        watched: list[Any] = [transport, self._woken]
        with self._shared:
            self._open = True
        while not self._closing.is_set():
            readable = select.select(watched, [], [], TICK_S)[0]
            if self._woken in readable:
                self._woken.recv(4096)
            data = transport.read() if transport in readable else b""
            with self._shared:
                now_s = self._clock()
                outgoing = []
                for message in parser.parse_buffer(data) or ():
                    outgoing += self._companion.heard(message, now_s)
                outgoing += self._companion.due(now_s)
                outgoing += self._outgoing
                self._outgoing.clear()
                packer.srcSystem = self._companion.system
                notices = self._notices()
            for message in outgoing:
                transport.write(message.pack(packer))
                packer.seq = (packer.seq + 1) % 256
            self._say_all(notices)

    def _notices(self) -> list[str]:
        notices = list(self._companion.notices)
        self._companion.notices.clear()
        return notices

    def _say_all(self, notices: list[str]) -> None:
        for line in notices:
            self._tell(line)

    def _say(self, words: str) -> None:
        self._tell(f"{self._settings.address}: {words}")

    def _say_once(self, words: str) -> None:
        if words not in self._told:
            self._told.add(words)
            self._say(words)


def _reason(error: Exception) -> str:
    """What the system says of a port that fails, in few words."""
    if isinstance(error, OSError) and error.errno and not isinstance(error, serial.SerialException):
        # gethostbyname has numbers of its own.
        return error.strerror or os.strerror(error.errno)
    return one_line(error, 100) or type(error).__name__
