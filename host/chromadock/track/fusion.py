"""What one measurement says: the state after it, and how well the two agree."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.many import normal_equations
from chromadock.geometry.pose import Sighting
from chromadock.track.motion import ATTITUDE, POSE, RATE, State, rotation, turn_between

Floats = NDArray[np.float64]

# Rounds of Gauss and Newton; from a frame's own minimum or the prediction two or three suffice.
_MAX_ROUNDS = 6
# A step of less than a thirtieth of the error ends them.
_CONVERGED = 1e-3
# Chi-square of a pose that ran away: its markers are 100,000 standard deviations off.
_RAN_AWAY = 1e10
# Of true measurements one in a thousand is gated out: 3.09 of a normal distribution.
_GATED = 3.09


@dataclass(frozen=True, eq=False, slots=True)
class Fused:
    """``state`` after a measurement of ``freedom`` numbers; ``chi_square`` of all that had to
    give way; ``log_likelihood`` of the measurement before it, up to what is the same for all."""

    state: State
    freedom: int
    chi_square: float
    log_likelihood: float

    @property
    def within_gate(self) -> bool:
        """Whether the measurement can be of this state.

        Quantile of chi-square: Wilson and Hilferty, PNAS 17 (1931) 684.
        """
        spread = 2 / (9 * self.freedom)
        most = self.freedom * (1 - spread + _GATED * np.sqrt(spread)) ** 3
        return bool(self.chi_square <= most)


def with_markers(
    state: State, seen: Sighting, R: Floats, t: Floats, smaller: float = 0.0
) -> Fused | None:
    """The markers of a frame: the most probable pose downhill of a start (R, t).

    An iterated extended Kalman filter (Bell and Cathey, IEEE Trans. Automatic Control 38
    (1993) 294) on the pixels themselves.  A pose measured in each frame alone is no
    measurement with a normal error: noise makes a plane that faces the camera look tilted, and
    the more it does the surer the tilt looks, so their mean is tilted too.

    ``smaller``: see ``look.Found``; the state's place is that of the markers' centroid.

    None where a marker would be out of the camera's view, or nowhere near.
    """
    P = state.covariance
    prior = np.linalg.inv(P[POSE, POSE])
    for _ in range(_MAX_ROUNDS):
        normal = _normal(seen, R, t)
        if normal is None:
            return None
        told, gradient, _ = normal
        off = np.concatenate([t - state.t, turn_between(state.R, R)])
        information = told + prior
        step = -np.linalg.solve(information, gradient + prior @ off)
        R, t = rotation(step[3:]) @ R, t + step[:3]
        if step @ information @ step < _CONVERGED:
            break
    normal = _normal(seen, R, t)
    if normal is None:
        return None
    told, gradient, misfit = normal
    off = np.concatenate([t - state.t, turn_between(state.R, R)])
    information = told + prior
    # What the pose tells of the rest.
    gain = P[:, POSE] @ prior
    left = np.linalg.inv(information) - P[POSE, POSE]
    chi_square = float(misfit + off @ prior @ off)
    # A dock that looks smaller by a share is farther by that share, and as much turned as before.
    farther = told[:, :3] @ (smaller * t)
    drawn = np.linalg.solve(information, prior @ state.drawn[POSE] + farther)
    drawn = state.drawn + gain @ (drawn - state.drawn[POSE])
    gained = np.linalg.slogdet(information)[1] - np.linalg.slogdet(prior)[1]
    return Fused(
        replace(state.corrected(gain @ off, P + gain @ left @ gain.T), drawn=drawn),
        seen.pixels.size,
        chi_square,
        -0.5 * chi_square - 0.5 * float(gained),
    )


def with_attitude(state: State, R_expected: Floats, covariance: Floats) -> Fused:
    """The dock's attitude R (3, 3), known to (3, 3) of small turns about the camera's axes."""
    off = turn_between(state.R, R_expected)
    return _fused(state, ATTITUDE, off, covariance)


def with_turn_rate(state: State, turn_rate: Floats, variance: float) -> Fused:
    """The camera's rate of turn (3,), rad/s, each number known to ``variance``."""
    return _fused(state, RATE, turn_rate - state.turn_rate, variance * np.eye(3))


def _normal(seen: Sighting, R: Floats, t: Floats) -> tuple[Floats, Floats, float] | None:
    """Information, gradient and chi-square of one pose, as of ``many.Normal``; None where a marker
    is out of view, or nowhere near."""
    information, gradient, chi_square, whole = normal_equations(seen, R[None], t[None])
    near = whole[0] and chi_square[0] < _RAN_AWAY
    return (information[0], gradient[0], float(chi_square[0])) if near else None


def _fused(state: State, part: slice, off: Floats, covariance: Floats) -> Fused:
    """Kalman's update by a measurement of one part of the state."""
    P = state.covariance
    spread = P[part, part] + covariance
    gain = np.linalg.solve(spread, P[part]).T
    chi_square = float(off @ np.linalg.solve(spread, off))
    log_likelihood = -0.5 * chi_square - 0.5 * float(np.linalg.slogdet(spread)[1])
    corrected = state.corrected(gain @ off, P - gain @ P[part])
    drawn = state.drawn - gain @ state.drawn[part]
    return Fused(replace(corrected, drawn=drawn), len(off), chi_square, log_likelihood)
