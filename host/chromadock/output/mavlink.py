"""Results to an autopilot by MAVLink, and, for a dry run, what it would make of them."""

from __future__ import annotations

from collections.abc import Callable

from chromadock.autopilot.dry_run import dry_run
from chromadock.autopilot.output import AutopilotOutput
from chromadock.autopilot.settings import AutopilotSettings
from chromadock.mounting import Mounting, mounting_or_default
from chromadock.output.results import ResultOutput
from chromadock.results.detection import Detection
from chromadock.sources import Frame
from chromadock.track.attitude import Attitude

_EVERY_S = 1.0
"""More lines of a dry run nobody reads."""


class MavlinkOutput(ResultOutput):
    """See ``autopilot.output``; ``tell`` is called by its thread too."""

    def __init__(
        self, settings: AutopilotSettings, mounting: Mounting | None, tell: Callable[[str], None]
    ) -> None:
        self._autopilot = AutopilotOutput(settings, mounting, tell)

    def attitude(self, time_s: float, age_s: float | None) -> Attitude | None:
        """The vehicle's, by the same link."""
        return self._autopilot.attitude(time_s, age_s)

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Tell the autopilot."""
        self._autopilot.write(frame.time_s, detection, age_s)

    def trouble(self) -> str | None:
        """Whether no vehicle is heard."""
        return None if self._autopilot.heard else "no heartbeat of the vehicle is heard"

    def close(self) -> None:
        """End the link."""
        self._autopilot.close()


class MavlinkDryRun(ResultOutput):
    """Tells once a second in words what the receiver would understand; nothing is sent."""

    def __init__(
        self, settings: AutopilotSettings, mounting: Mounting | None, tell: Callable[[str], None]
    ) -> None:
        self._settings = settings
        self._mounting = mounting_or_default(mounting)
        self._tell = tell
        self._told_s: float | None = None

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Say what would be understood."""
        track = detection.track
        late = self._told_s is None or not 0 <= frame.time_s - self._told_s < _EVERY_S
        lines = dry_run(self._settings, frame.time_s, track, self._mounting) if track else []
        if lines and late:
            self._told_s = frame.time_s
            for line in lines:
                self._tell(f"{self._settings.receiver.name} at {frame.time_s:.1f} s: {line}")
