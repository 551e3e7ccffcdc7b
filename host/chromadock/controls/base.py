"""What every way to a camera's controls looks like.

Controls have the numbers that V4L2 gives them, their values are the driver's integers.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

from chromadock.closable import Closable
from chromadock.errors import ChromadockError


class ControlsAwayError(ChromadockError):
    """The controls cannot be reached now; later they may be."""


class RefusedError(Exception):
    """One value was refused; the text is the reason that was given."""


@dataclass(frozen=True, slots=True)
class Control:
    """One control as it is now.

    ``value``: what it is set to, None where it cannot be read; ``low``, ``high``, ``step``: what it
    takes, both ends included; ``choices``: of a menu or a switch, the values that there are, else
    empty.
    """

    value: int | None
    low: int
    high: int
    step: int = 1
    choices: frozenset[int] = frozenset()

    def nearest(self, value: float) -> int:
        """The value nearest to ``value`` that lies in the range and on a step."""
        step = max(self.step, 1)
        steps = round((min(max(value, self.low), self.high) - self.low) / step)
        return self.low + step * min(steps, (self.high - self.low) // step)


Table = Mapping[int, Control]
"""The controls of a camera by their numbers in V4L2."""


class Controls(Closable, ABC):
    """The controls of one camera, for a short while; use it as a context manager.

    ``keeps``: who keeps the values, as messages name it.
    """

    keeps: str

    @abstractmethod
    def read(self) -> Table:
        """All controls that there are of those in ``features``, as they are now.

        Raises
        ------
        ControlsAwayError
            One line, where they cannot be reached.
        """

    @abstractmethod
    def write(self, number: int, value: int) -> None:
        """Set one control.

        Raises
        ------
        RefusedError
            Where the value is not taken.
        ControlsAwayError
            As in ``read``.
        """
