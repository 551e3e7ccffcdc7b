"""What delivers the frames of one camera, pipeline or stream, as long as it is there."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.choices import DEFAULT_FPS


@dataclass(frozen=True, eq=False, slots=True)
class Shot:
    """One picture as it was delivered: ``image`` (H, W, 3) uint8 BGR.

    ``stamp_s``: seconds on the clock of whoever took it, None where nobody stamps.
    """

    image: NDArray[np.uint8]
    stamp_s: float | None


class Grabber(ABC):
    """Delivers pictures one by one; a broken one is closed and another opened.

    ``fps``: frames a second, nominal; ``monotonic``: whether stamps are of this computer's
    monotonic clock, as those of Linux camera drivers are.
    """

    fps: float = DEFAULT_FPS
    monotonic: bool = False

    @abstractmethod
    def grab(self) -> Shot | None:
        """Wait for the next picture; None where no more will come."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the camera or the connection."""
