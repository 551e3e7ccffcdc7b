"""What every source of frames looks like."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from chromadock.choices import DEFAULT_FPS
from chromadock.closable import Closable
from chromadock.track.attitude import Attitude

OnFault = Callable[[str], None]
"""Takes one line about a picture that was skipped, or a video that ends too early; or about
what had to be assumed."""


def ignore(_line: str) -> None:
    """The ``OnFault`` of a caller who looks at ``Source.errors`` and ``cut_short``."""


@dataclass(frozen=True, eq=False)
class Frame:
    """One picture: ``image`` HxWx3 uint8 BGR, the ``name`` of its file or camera, its
    ``index`` in the source from 0 and its ``time_s``, when it was taken, in seconds from the
    start.  ``attitude``: the vehicle's at that time, None where nobody told it."""

    image: NDArray[np.uint8]
    name: str
    index: int
    time_s: float
    attitude: Attitude | None = None


class Source(Closable, ABC):
    """An iterable of ``Frame``; use it as a context manager or call ``close``.

    Attributes
    ----------
    count
        About how many frames there are, or None where nobody knows; a video's header promises
        nothing.
    fps
        Nominal frames a second.
    live
        True for cameras and streams, which have no end of their own.
    errors
        Pictures skipped so far because they could not be read.
    dropped
        Pictures of a live source so far that a newer one came after before anybody asked.
    cut_short
        True once it is found that the source breaks off before its end.
    places
        Files it reads, and folders of pictures; an output must not go there.
    """

    count: int | None = None
    fps: float = DEFAULT_FPS
    live: bool = False
    errors: int = 0
    dropped: int = 0
    cut_short: bool = False
    places: frozenset[Path] = frozenset()

    @abstractmethod
    def __iter__(self) -> Iterator[Frame]:
        """Frames in order.

        Raises
        ------
        ChromadockError
            Where the source breaks off.
        """

    def now(self) -> float | None:
        """This moment on the clock of a live source's ``Frame.time_s``; None of a recording."""
        return None
