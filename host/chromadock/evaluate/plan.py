"""An evaluation cut into chunks of consecutive frames, each to be worked on its own."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from chromadock import method
from chromadock.evaluate.fingerprint import fingerprint
from chromadock.evaluate.photographs import folder_digest
from chromadock.evaluate.runs import Run
from chromadock.evaluate.store import digest
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.version import code_digest

CHUNK_FRAMES = 50
"""At least; a chunk is also twenty times as long as its warm-up, which is rendered in vain."""
_WARM_UPS = 20


@dataclass(frozen=True, eq=False)
class Chunk:
    """Frames ``first`` up to, not including, ``end`` of a run; ``key`` names its results.

    ``sample`` is the frame that the gallery shows, if it is in this chunk.
    """

    run: Run
    first: int
    end: int
    sample: int | None
    key: str

    @property
    def frames(self) -> int:
        """How many."""
        return self.end - self.first

    @property
    def warm_up(self) -> int:
        """From this frame on the rolling mean of the chunk's first frame takes decisions."""
        return max(0, self.first - warm_up_frames(self.run.rate_hz))


def warm_up_frames(rate_hz: float) -> int:
    """How many frames before one count in its rolling mean, at most."""
    in_window = math.ceil(method.WINDOW_MS / 1000 * rate_hz)
    return min(in_window, method.WINDOW_CAPACITY - 1)


def planned(runs: Iterable[Run], tuned: Tuned) -> list[Chunk]:
    """All chunks of the runs, in order."""
    chunks = []
    for run in runs:
        size = max(CHUNK_FRAMES, _WARM_UPS * warm_up_frames(run.rate_hz))
        made_from = run_digest(run) + fingerprint(tuned.to_dict())
        for first in range(0, run.frames, size):
            end = min(first + size, run.frames)
            sample = run.frames // 2 if first <= run.frames // 2 < end else None
            key = digest(f"{made_from} {first} {end} {sample}".encode())
            chunks.append(Chunk(run, first, end, sample, key))
    return chunks


def run_digest(run: Run) -> str:
    """Of all that the run's frames are made from: scene, code, photographs, what is asked."""
    photographs = "" if run.photographs is None else folder_digest(run.photographs)
    return digest(f"{fingerprint(run)} {photographs} {code_digest()}".encode())
