"""A dock that was seen, but is not trusted yet."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.track.bank import Bank
from chromadock.track.sight import Sight

LOCK_FRAMES = 3
"""Frames that found a whole dock, or four markers of it at least, each where the ones before have
it."""

LOCK_SPAN_S = 0.1
"""Between the first and the last of them: a glint lasts a few hundredths of a second."""

LOCK_EVIDENCE = 5.0
"""Decades, of the best frame: a dock in a pool has more from 8 m on; clutter, which is not quite
what robust/weigh/acceptance.py supposes of it, seldom has (tests/host/track/test_detector.py prints
what shaken views of real water come to).  The best, not the sum: frames of one scene are no
independent evidence."""

LOCK_SHARE = 0.5
"""Of the looks since the first that found it: clutter that looks like a dock does so in one frame
and not in the next (the likest of the real photographs in a quarter of them), a dock in nearly all
until it is about to be out of reach."""

PATIENT_EVIDENCE = 3.0
PATIENT_FRAMES = 10
PATIENT_SPAN_S = 2.0
"""Less evidence of the best frame will do, or frames with a marker out, where so many agree over
so long: three pictures in a thousand of clutter had 2.5 decades when last counted, and few of those
have as much again and again where a moving vehicle must see it.  Over that time vehicle and dock
sway: it shows which marker is out."""

RIVAL_FRAMES = 2
RIVAL_EVIDENCE = 0.5
"""So many frames with so large a share of the decades of the dock that is tracked make a candidate
its rival: searches of whole frames see it where they do not see that dock."""

GIVEN_UP_S = 0.5
"""A candidate not seen for so long is dropped: a better one begins anew."""


@dataclass(frozen=True, eq=False, slots=True)
class Candidate:
    """``bank`` at ``time_s``, the last of ``frames`` that saw it, ``telling`` (see ``Sight``) in so
    many of them, of so many ``looks`` since ``since_s``; ``evidence`` of the best."""

    bank: Bank
    since_s: float
    time_s: float
    frames: int
    telling: int
    looks: int
    evidence: float

    @classmethod
    def of(cls, sight: Sight, evidence: float, time_s: float) -> Candidate:
        """From the first frame."""
        return cls(Bank.of(sight), time_s, time_s, 1, int(sight.telling), 1, evidence)

    def pose(self, time_s: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(3, 3) and (3,): where it is expected at a time after the last frame that saw it."""
        state = self.bank.after(time_s - self.time_s).hypotheses[0].state
        return state.R, state.t

    def seen(self, sight: Sight, evidence: float, time_s: float) -> Candidate | None:
        """After another frame with a dock; None where that is elsewhere."""
        bank = self.bank.after(time_s - self.time_s).seen(sight)
        if bank is None or bank.missed:
            return None
        best = max(self.evidence, evidence)
        return replace(
            self,
            bank=bank,
            time_s=time_s,
            frames=self.frames + 1,
            telling=self.telling + sight.telling,
            evidence=best,
        )

    def looked_for(self) -> Candidate:
        """With one more look at a whole frame, whatever that found."""
        return replace(self, looks=self.looks + 1)

    def locked(self, rival: bool) -> bool:
        """Whether it is to be trusted now; a ``rival`` of a tracked dock must be patient."""
        span_s = self.time_s - self.since_s
        strong = not rival and self.evidence >= LOCK_EVIDENCE and self.telling >= LOCK_FRAMES
        patient = self.evidence >= PATIENT_EVIDENCE and self.frames >= PATIENT_FRAMES
        long = (strong and span_s >= LOCK_SPAN_S) or (patient and span_s >= PATIENT_SPAN_S)
        return long and self.frames >= LOCK_SHARE * self.looks

    def rivals(self, evidence: float) -> bool:
        """Whether a tracked dock of that evidence, in decades, may be the wrong one of the two."""
        return self.frames >= RIVAL_FRAMES and self.evidence >= RIVAL_EVIDENCE * evidence

    def given_up(self, time_s: float) -> bool:
        """Whether it was last seen too long ago."""
        return time_s - self.time_s > GIVEN_UP_S
