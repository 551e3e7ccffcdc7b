"""An output that may fail without stopping the detection."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from chromadock.back_off import FIRST_RETRY_S, LONGEST_RETRY_S
from chromadock.errors import ChromadockError
from chromadock.output.results import ResultOutput
from chromadock.results.detection import Detection
from chromadock.sources import Frame
from chromadock.track.attitude import Attitude


class Guarded(ResultOutput):
    """Passes results on to ``output``; what that raises is told once, and tried again later.

    Parameters
    ----------
    tell : takes one line when the output fails, and one when it works again.
    now : the monotonic clock, seconds.
    """

    def __init__(
        self,
        output: ResultOutput,
        tell: Callable[[str], None],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._output = output
        self._tell = tell
        self._now = now
        self._failed_s: float | None = None
        self._again_s = 0.0
        self._wait_s = FIRST_RETRY_S
        self._lost = 0
        self._fault = self._reason = ""

    def attitude(self, time_s: float, age_s: float | None) -> Attitude | None:
        """See ``ResultOutput``."""
        return self._output.attitude(time_s, age_s)

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Pass a result on, or count it as lost."""
        now_s = self._now()
        if self._failed_s is not None and now_s < self._again_s:
            self._lost += 1
            return
        try:
            self._output.write(frame, detection, age_s)
        except (ChromadockError, OSError) as error:
            self._fails(error, now_s)
            return
        if self._failed_s is not None:
            self._tell(
                f"warning: {self._fault}: works again after {now_s - self._failed_s:.1f} s, "
                f"{self._lost} results lost"
            )
            self._failed_s, self._lost, self._wait_s = None, 0, FIRST_RETRY_S

    def _fails(self, error: Exception, now_s: float) -> None:
        self._lost += 1
        self._again_s = now_s + self._wait_s
        self._wait_s = min(2 * self._wait_s, LONGEST_RETRY_S)
        self._reason = str(error)
        if self._failed_s is None:
            self._failed_s, self._fault = now_s, str(error).split(": ", 1)[0]
            self._tell(f"warning: {error}: the detection goes on, and it is tried again")

    def trouble(self) -> str | None:
        """What befell the output and is not over, or what it says itself."""
        if self._failed_s is not None:
            return f"{self._reason}; {self._lost} results lost"
        return self._output.trouble()

    def beside(self, outputs: Mapping[str, ResultOutput]) -> None:
        """See ``ResultOutput``."""
        self._output.beside(outputs)

    def close(self) -> None:
        """Close the output; at the end nothing is tried again."""
        try:
            self._output.close()
        except (ChromadockError, OSError) as error:
            self._tell(f"warning: {error}")
