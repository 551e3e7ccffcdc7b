"""The dock from frame to frame: where to look, and what the looks come to."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.look import Found
from chromadock.mounting import Mounting, mounting_or_default
from chromadock.pose import Estimate
from chromadock.track.attitude import Attitude, expected, expected_if_told
from chromadock.track.bank import Bank
from chromadock.track.candidate import LOCK_EVIDENCE, Candidate
from chromadock.track.motion import POSE
from chromadock.track.result import Track
from chromadock.track.sight import Sight
from chromadock.track.states import KEPT_S, TRACKING_S, state_of

KEEP_EVIDENCE = 2.5
"""Decades, of markers where the track has them: specks there would draw it away, and a frame
missed costs nothing."""

FULL_SEARCH_S = 0.5
"""While a dock is tracked the whole frame is searched this often: a wrong lock is left within four
seconds, and the search costs little on the average."""

INCOMPLETE_SEARCH_S = 0.25
"""Without a whole dock in sight one with a marker out is searched for this often: it costs as much
as a whole dock's search for each marker."""

CORRELATION_S = 0.2
"""Frames closer than this share their errors, by the same pixels under a marker and the same
waves, and count together for one frame."""

PARTIAL_CORRELATION_S = 1.0
"""The same with a marker out: what is left of a systematic error of a tenth of a pixel, half a
degree of a whole dock's attitude, is ten degrees then, and no number of frames makes it less."""

FACING_CORRELATION_S = 7.0
"""The same of the dock's attitude as the vehicle expects it: mounting and course last, so the
track never gets surer by it than it is, with motion.DOCK_TURNING for what it forgets."""

RESTART_S = 1.0
"""A frame older than the newest by more is the start of another recording: the track begins anew.
Less is a frame that comes late, which is not used."""

MAX_PRIORS = 2
"""Poses about which a frame is searched: each costs time."""

MAX_CANDIDATES = 3
"""Docks that are not trusted yet: a true one besides two of clutter."""

_LONGEST_ATTITUDE_GAP_S = 0.5  # a mean rate over a longer time is no rate


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """How to look at the next frame: see ``look.Look``."""

    priors: tuple[Estimate, ...] = ()
    everywhere: bool = True
    incomplete: bool = False
    R_expected: NDArray[np.float64] | None = None
    R_covariance: NDArray[np.float64] | None = None


@dataclass(frozen=True, eq=False, slots=True)
class _Locked:
    """``bank`` at ``time_s``; ``measured_s``: when the dock was last seen, ``whole`` or not."""

    bank: Bank
    time_s: float
    measured_s: float
    whole: bool


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
        self._dock = DockGeometry(dock.names, dock.points - dock.centre, dock.source)
        self._told = mounting
        self._mounting = mounting_or_default(mounting)
        self._reset()

    def _reset(self) -> None:
        self._time_s: float | None = None
        self._locked: _Locked | None = None
        self._candidates: list[Candidate] = []
        self._last_seen_s: float | None = None
        self._last_full_s = -np.inf
        self._last_was_full = False
        self._last_incomplete_s = -np.inf
        self._last_markers: dict[str, tuple[float, float]] | None = None
        self._attitude: tuple[float, Attitude] | None = None
        self._faced_s = -np.inf

    def plan(self, time_s: float, attitude: Attitude | None = None) -> Plan:
        """How to look at a frame of ``time_s``, taken at that attitude; it changes nothing.

        Evidence for another dock counts only as seen without any expectation, so each look is
        either about the priors or everywhere, never both.
        """
        locked = self._kept(time_s)
        R_expected, R_covariance = expected_if_told(attitude, self._told)
        if locked is None or self._full_is_due(locked, time_s):
            partly = locked is None or not locked.whole
            incomplete = partly and self._incomplete_is_due(time_s)
            return Plan((), True, incomplete, R_expected, R_covariance)
        bank = locked.bank.after(max(time_s - locked.time_s, 0.0)).about(-self._centre)
        likeliest = sorted(bank.hypotheses, key=lambda h: -h.weight)[:MAX_PRIORS]
        priors = tuple(
            Estimate(
                h.state.R,
                h.state.t,
                0.0,
                0.0,
                np.asarray(np.linalg.inv(h.state.covariance[POSE, POSE]), np.float64),
            )
            for h in likeliest
        )
        return Plan(priors, False, False, R_expected, R_covariance)

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
        than RESTART_S starts anew.
        """
        if self._time_s is not None and time_s <= self._time_s:
            if time_s > self._time_s - RESTART_S:
                return self.at(time_s)
            self._reset()
        self._time_s = time_s
        self._last_was_full = plan.everywhere
        if plan.everywhere:
            self._last_full_s = time_s
        if plan.incomplete:
            self._last_incomplete_s = time_s
        self._run_on(time_s, plan, attitude)
        sight = self._sight(plan, found, camera)
        if sight is not None:
            evidence = found.evidence or 0.0
            followed = self._followed(sight, evidence, time_s, plan)
            if not followed and plan.everywhere:
                self._propose(sight, evidence, time_s)
        return self.at(time_s)

    def at(self, time_s: float) -> Track:
        """The track run on to any time, say from a frame's to now: latency taken out.

        At a time before the newest frame's it is that of the newest.
        """
        time_s = max(time_s, -np.inf if self._time_s is None else self._time_s)
        seen = self._last_seen_s
        age_s = None if seen is None else time_s - seen
        locked = self._locked
        state = state_of(
            None if locked is None else time_s - locked.measured_s,
            any(not c.given_up(time_s) for c in self._candidates),
            seen is not None,
        )
        if locked is None or state not in ("tracking", "recently_lost"):
            return Track(state, time_s, age_s=age_s)
        bank = locked.bank.after(time_s - locked.time_s).about(-self._centre)
        return Track.following(state, time_s, bank.hypotheses, time_s - locked.measured_s)

    def _kept(self, time_s: float) -> _Locked | None:
        """The locked dock, unless it was last measured too long before."""
        locked = self._locked
        return None if locked is None or time_s - locked.measured_s > KEPT_S else locked

    def _full_is_due(self, locked: _Locked, time_s: float) -> bool:
        """Not twice in a row, that a dock with a marker out is looked for in between."""
        if self._last_was_full:
            return False
        unsure = bool(self._candidates) or time_s - locked.measured_s > TRACKING_S
        return unsure or time_s - self._last_full_s >= FULL_SEARCH_S

    def _incomplete_is_due(self, time_s: float) -> bool:
        """Now and then, and at every frame that may confirm what there is."""
        return bool(self._candidates) or time_s - self._last_incomplete_s >= INCOMPLETE_SEARCH_S

    def _run_on(self, time_s: float, plan: Plan, attitude: Attitude | None) -> None:
        """Both kinds of docks to this frame's time, with what the vehicle knows."""
        self._candidates = [
            c.looked_for() if plan.everywhere else c
            for c in self._candidates
            if not c.given_up(time_s)
        ]
        locked = self._kept(time_s)
        if locked is not None:
            bank = locked.bank
            elapsed_s = time_s - locked.time_s
            turn_rate = self._turn_rate(time_s, attitude)
            if turn_rate is not None:
                bank = bank.turning(turn_rate)
            bank = bank.after(elapsed_s)
            share = min(1.0, (time_s - self._faced_s) / FACING_CORRELATION_S)
            R, covariance = expected(attitude, self._mounting)
            bank = bank.facing(R, covariance / share)
            self._faced_s = time_s
            locked = replace(locked, bank=bank, time_s=time_s)
        self._locked = locked
        self._attitude = None if attitude is None else (time_s, attitude)

    def _turn_rate(self, time_s: float, attitude: Attitude | None) -> NDArray[np.float64] | None:
        """(3,) rad/s: of the camera since the last frame."""
        if attitude is None or self._attitude is None:
            return None
        earlier_s, earlier = self._attitude
        turn = attitude.turn_since(earlier, self._mounting.R_body_camera)
        if turn is None or time_s - earlier_s > _LONGEST_ATTITUDE_GAP_S:
            return None
        return np.asarray(turn / (time_s - earlier_s))

    def _sight(self, plan: Plan, found: Found, camera: CameraModel) -> Sight | None:
        """The frame's markers; none of a picture that has been seen already.

        Noise alone moves a marker by a thousandth of a pixel: places that are the same to the
        last bit are the same picture again, from a camera or a driver that hangs.
        """
        if found.markers is None or not found.estimates or found.markers == self._last_markers:
            return None
        if not plan.everywhere and (found.evidence or 0.0) < KEEP_EVIDENCE:
            return None
        self._last_markers = found.markers
        poses = [pose.about(self._centre) for pose in found.estimates]
        return Sight.of(found.markers, poses, self._dock, camera)

    def _followed(self, sight: Sight, evidence: float, time_s: float, plan: Plan) -> bool:
        """Whether the locked dock was measured.

        One out of sight may be anywhere soon, and three markers of four leave open where the
        fourth would be: what is found then must speak for itself.
        """
        locked = self._locked
        if locked is None:
            return False
        unsure = time_s - locked.measured_s > TRACKING_S or (sight.whole and not locked.whole)
        if plan.everywhere and unsure and evidence < LOCK_EVIDENCE:
            return False
        bank = locked.bank.seen(sight.worth(_share(sight, time_s - locked.measured_s)))
        if bank is None:
            return False
        self._locked = _Locked(bank.doubting(sight), time_s, time_s, sight.whole)
        self._last_seen_s = time_s
        if plan.everywhere:  # what stands out most is this dock: others are none
            self._candidates.clear()
        return True

    def _propose(self, sight: Sight, evidence: float, time_s: float) -> None:
        """A dock where none is locked: a new candidate, or one more frame of one; or the lock."""
        for i, candidate in enumerate(self._candidates):
            new = sight.worth(_share(sight, time_s - candidate.time_s))
            after = candidate.seen(new, evidence, time_s)
            if after is not None:
                self._candidates[i] = after
                break
        else:
            after = Candidate.of(sight, evidence, time_s)
            self._candidates.append(after)
            self._candidates = self._candidates[-MAX_CANDIDATES:]
        locked = self._locked
        rival = locked is not None and time_s - locked.measured_s <= TRACKING_S
        if after.locked(rival):
            self._locked = _Locked(after.bank, time_s, time_s, sight.whole)
            self._last_seen_s = time_s
            self._faced_s = -np.inf
            self._candidates.clear()


def _share(sight: Sight, elapsed_s: float) -> float:
    """How much of a frame is new after the last."""
    return min(1.0, elapsed_s / (CORRELATION_S if sight.whole else PARTIAL_CORRELATION_S))
