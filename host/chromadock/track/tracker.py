"""The dock from frame to frame: where to look, and what the looks come to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.look import Found
from chromadock.mounting import Mounting, mounting_or_default
from chromadock.results.track import Track
from chromadock.track.attitude import Attitude, expected, expected_if_told
from chromadock.track.bank import Bank
from chromadock.track.candidate import LOCK_EVIDENCE, Candidate
from chromadock.track.manoeuvre import decided, later, missed
from chromadock.track.memory import Locked, Memory
from chromadock.track.motion import turning_of
from chromadock.track.plan import Plan, full_is_due, incomplete_is_due, priors
from chromadock.track.sight import Sight
from chromadock.track.states import (
    MOST_DOUBT,
    MOST_DOUBT_KEPT,
    MOST_DOUBT_UNSEEN,
    MOST_ELSEWHERE,
    TRACKING_S,
)

KEEP_EVIDENCE = 3.0
"""Decades, of markers where the track has them: specks there would draw it away, and a frame
missed costs nothing."""

LEFT_OF_EVIDENCE = 0.5
"""Of the decades that a dock had, of what is taken for it where its place is no longer known: a
look about an expectation so vague is one everywhere, and finds what stands a little like a dock."""

CORRELATION_S = 0.2
"""Frames closer than this share their errors, by the same pixels under a marker and the same
waves, and count together for one frame."""

BARE_CORRELATION_S = 1.0
"""The same with a marker out, and of a dock that has three markers only: a systematic error of a
tenth of a pixel is half a degree of attitude where four markers are seen, and ten degrees of three.
No number of frames makes it less, and three markers fit so well that nothing tells of it."""

FACING_CORRELATION_S = 7.0
"""The same of the dock's attitude as the vehicle expects it: mounting and course last, so the
track never gets surer by it than it is, with motion.DOCK_TURNING for what it forgets."""

RESTART_S = 1.0
"""A frame older than the newest by more is the start of another recording: the track begins anew.
Less is a frame that comes late, which is not used."""

MAX_CANDIDATES = 3
"""Docks that are not trusted yet: a true one besides two of clutter."""


class Tracker:
    """Follows one dock; time is what its caller says it is.

    The filter's own dock frame has its origin at the markers' centroid, about which errors of
    place and attitude are about independent, so that it does not matter where the dock's own
    origin lies; whatever comes in or goes out is of the dock's own frame.

    Parameters
    ----------
    dock
        Its markers.
    mounting
        How the camera sits in the vehicle and how the dock hangs; None for a camera that looks
        ahead and a dock that hangs level and faces the approach.
    """

    def __init__(self, dock: DockGeometry, mounting: Mounting | None = None) -> None:
        self._centre = dock.centre
        self._judged = dock.judged - dock.centre
        self._dock = replace(dock, points=dock.points - dock.centre)
        self._told = mounting
        self._mounting = mounting_or_default(mounting)
        self._expected_level = expected(None, self._mounting)
        self._memory = Memory()

    def plan(self, time_s: float, attitude: Attitude | None = None) -> Plan:
        """How to look at a frame of ``time_s``, taken at that attitude; it changes nothing.

        Evidence for another dock counts only as seen without any expectation, so each look is
        either about the priors or everywhere, never both.
        """
        memory = self._memory
        locked = memory.kept(time_s)
        R, covariance = expected_if_told(attitude, self._told)
        if locked is None or full_is_due(memory, time_s):
            return Plan((), True, incomplete_is_due(memory, time_s), R, covariance)
        bank = locked.after(max(time_s - locked.time_s, 0.0))
        return Plan(priors(bank.about(-self._centre)), False, False, R, covariance)

    def update(
        self,
        time_s: float,
        plan: Plan,
        found: Found,
        camera: CameraModel,
        attitude: Attitude | None = None,
    ) -> Track:
        """Take in what was found in the frame of ``time_s`` by a plan made for it.

        A frame not newer than the newest says nothing new and is not used; one older by more
        than RESTART_S starts anew.  Frames come from one thread at a time.
        """
        memory = self._memory
        if memory.time_s is not None and time_s <= memory.time_s:
            if time_s > memory.time_s - RESTART_S:
                return self.at(time_s)
            memory = Memory()
        memory = _looked(memory, time_s, plan)
        telemetry = memory.telemetry.heard(time_s, attitude, self._mounting.R_body_camera)
        memory = replace(memory, telemetry=telemetry)
        predicted = self._prediction(memory, time_s)
        sight, after = self._sight(memory, plan, found, camera), None
        evidence = found.evidence or 0.0
        if sight is not None:
            memory = replace(memory, last_markers=found.markers)
            after = self._followed(memory, predicted, sight, evidence, time_s, plan)
        memory = after or _unseen(memory, predicted, time_s)
        measured = memory.locked is not None and memory.locked.measured_s == time_s
        if sight is not None and not measured and plan.everywhere:
            known = [c for c in memory.candidates if evidence < c.evidence]
            if not any(sight.misnamed(self._dock, *c.pose(time_s)) for c in known):
                memory = _proposed(memory, sight, evidence, time_s, self._judged)
        # Published at once, when all is done: see ``at``.
        self._memory = memory
        return self.at(time_s)

    def at(self, time_s: float) -> Track:
        """The track run on to any time, say from a frame's to now: latency taken out.

        At a time before the newest frame's it is that of the newest.  Any thread may ask while
        another is in ``update``: the answer is wholly by the frames before that one or by it too.
        """
        return self._memory.track(time_s, -self._centre, self._judged)

    def _prediction(self, memory: Memory, time_s: float) -> Prediction | None:
        """Of the locked dock at this frame's time, with what the vehicle knows; of one that has
        manoeuvred since the last with a probability that is still open."""
        locked, telemetry = memory.kept(time_s), memory.telemetry
        if locked is None:
            return None
        elapsed_s = time_s - locked.time_s
        # An attitude that is not new is some tenths of a second old, and says nothing new.
        faced = telemetry.fresh is not None or telemetry.silent(time_s)
        share = min(1.0, (time_s - memory.faced_s) / FACING_CORRELATION_S)
        R, covariance = self._expected_level
        if telemetry.fresh is not None:
            R, covariance = expected(telemetry.fresh, self._mounting)

        def predicted(swift: float) -> Bank:
            bank, turn = locked.bank, telemetry.turn
            if turn is not None:
                # From its value at the last frame to its mean since, and where that is of a longer
                # time, to that: a Wiener process against its mean over a time.
                per_s = turning_of(swift) ** 2 / 3
                older = per_s * max(turn.over_s - elapsed_s, 0.0)
                bank = bank.turning(turn.rate, turn.variance + older, per_s * elapsed_s)
            bank = bank.after(elapsed_s, swift)
            return bank.facing(R, covariance / share) if faced else bank

        swift = later(locked.swift, elapsed_s)
        return Prediction(locked, cache(predicted), swift, time_s if faced else memory.faced_s)

    def _followed(
        self,
        memory: Memory,
        predicted: Prediction | None,
        sight: Sight,
        evidence: float,
        time_s: float,
        plan: Plan,
    ) -> Memory | None:
        """After a frame that is of the locked dock, or may be; None where it is not.

        One out of sight may be anywhere soon, and three markers of four leave open where the
        fourth would be: what is found then must speak for itself.
        """
        if predicted is None:
            return None
        locked = predicted.locked
        hidden = time_s - locked.measured_s > TRACKING_S
        unsure = hidden or (sight.whole and not locked.whole)
        if plan.everywhere and unsure and evidence < LOCK_EVIDENCE:
            return None
        if hidden and evidence < max(LOCK_EVIDENCE, LEFT_OF_EVIDENCE * locked.evidence):
            expected = predicted.bank(predicted.swift).about(self._judged)
            if expected.doubt > MOST_DOUBT_UNSEEN:
                return None
        if evidence < locked.evidence:
            first = predicted.bank(0.0).hypotheses[0].state
            if sight.misnamed(self._dock, first.R, first.t):
                return None
        new = sight.worth(_share(sight, time_s - locked.measured_s))
        after = decided(predicted.bank, new, predicted.swift)
        if after is None:
            return None
        bank, swift = after
        if bank.missed:
            sure = locked.sure and _sure(bank.about(self._judged), True)
            unseen = replace(locked, bank=bank, time_s=time_s, swift=missed(swift), sure=sure)
            return replace(memory, locked=unseen, faced_s=predicted.faced_s)
        bank = bank.doubting(sight)
        sure = _sure(bank.about(self._judged), locked.sure)
        return replace(
            memory,
            locked=Locked(bank, time_s, time_s, sight.whole, evidence, sure, swift),
            last_seen_s=time_s,
            faced_s=predicted.faced_s,
            # What stands out most is this dock: others are none.
            candidates=() if plan.everywhere else memory.candidates,
        )

    def _sight(self, memory: Memory, plan: Plan, found: Found, camera: CameraModel) -> Sight | None:
        """The frame's markers; none of a picture that has been seen already.

        Noise alone moves a marker by a thousandth of a pixel: places that are the same to the
        last bit are the same picture again, from a camera or a driver that hangs.
        """
        if found.markers is None or not found.estimates or found.markers == memory.last_markers:
            return None
        if not plan.everywhere and (found.evidence or 0.0) < KEEP_EVIDENCE:
            return None
        poses = [pose.about(self._centre) for pose in found.estimates]
        return Sight.of(found.markers, found.sigma_px, poses, self._dock, camera, found.smaller)


def _looked(memory: Memory, time_s: float, plan: Plan) -> Memory:
    """After a look by a plan, whatever it found."""
    return replace(
        memory,
        time_s=time_s,
        candidates=tuple(
            c.looked_for() if plan.everywhere else c
            for c in memory.candidates
            if not c.given_up(time_s)
        ),
        last_was_full=plan.everywhere,
        last_full_s=time_s if plan.everywhere else memory.last_full_s,
        last_incomplete_s=time_s if plan.incomplete else memory.last_incomplete_s,
    )


@dataclass(frozen=True, eq=False, slots=True)
class Prediction:
    """``bank(p)``: at a frame's time, of a vehicle that manoeuvres with probability p; ``swift``:
    that of this one; ``locked``: what it was made of; ``faced_s``: when the dock's expected
    attitude was last taken in."""

    locked: Locked
    bank: Callable[[float], Bank]
    swift: float
    faced_s: float


def _unseen(memory: Memory, predicted: Prediction | None, time_s: float) -> Memory:
    """After a frame that did not show the locked dock, be it for a manoeuvre since the last."""
    if predicted is None:
        return replace(memory, locked=None)
    swift = missed(predicted.swift)
    bank = predicted.bank(swift)
    locked = replace(predicted.locked, bank=bank, time_s=time_s, swift=swift)
    return replace(memory, locked=locked, faced_s=predicted.faced_s)


def _proposed(
    memory: Memory, sight: Sight, evidence: float, time_s: float, judged: NDArray[np.float64]
) -> Memory:
    """With a dock where none is locked: a new candidate, one more frame of one, or the lock.

    ``judged`` (3,): metres, in the filter's dock frame: see ``DockGeometry.judged``.
    """
    candidates = list(memory.candidates)
    for i, candidate in enumerate(candidates):
        new = sight.worth(_share(sight, time_s - candidate.time_s))
        after = candidate.seen(new, evidence, time_s)
        if after is not None:
            candidates[i] = after
            break
    else:
        after = Candidate.of(sight, evidence, time_s)
        candidates = [*candidates, after][-MAX_CANDIDATES:]
    locked = memory.locked
    rival = (
        locked is not None
        and time_s - locked.measured_s <= TRACKING_S
        and after.evidence < locked.evidence + LOCK_EVIDENCE
    )
    if not after.locked(rival):
        return replace(memory, candidates=tuple(candidates))
    sure = _sure(after.bank.about(judged), False)
    return replace(
        memory,
        locked=Locked(after.bank, time_s, time_s, sight.whole, evidence, sure),
        last_seen_s=time_s,
        faced_s=-np.inf,
        candidates=(),
    )


def _sure(bank: Bank, before: bool) -> bool:
    """Whether a pose of a dock that was just measured is told.

    ``bank``: about the point that it is judged by; ``before``: whether one was told before.
    """
    if before:
        return bank.doubt <= MOST_DOUBT_KEPT
    return bank.doubt <= MOST_DOUBT and bank.elsewhere <= MOST_ELSEWHERE


def _share(sight: Sight, elapsed_s: float) -> float:
    """How much of a frame is new after the last."""
    lasting_s = CORRELATION_S if sight.whole and not sight.exact else BARE_CORRELATION_S
    return min(1.0, elapsed_s / lasting_s)
