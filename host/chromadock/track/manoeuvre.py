"""Whether the vehicle manoeuvres.

Most of the time it swims quietly, and what a frame shows agrees with that; now and then it turns or
brakes hard.  Two models of motion with a Markov chain between them (Bar-Shalom, Li, Kirubarajan,
Estimation with Applications to Tracking and Navigation, 2001, section 11.6), of which the likelier
goes on: a quiet approach is filtered as if there were no other.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from chromadock.track.bank import Bank
from chromadock.track.sight import Sight

SELDOM = 0.05
"""Probability of a manoeuvre when nothing tells."""

LASTS_S = 1.0
"""How long a manoeuvre that was seen is expected to go on."""

SURPRISING = 2.0
"""Chi-square over its degrees of freedom up to which a frame is what a quiet vehicle shows: one in
twenty to fifty is beyond, and is looked at for a manoeuvre as well."""

MISSES = 3.0
"""Frames that miss the dock, of a vehicle that manoeuvres, to those of one that swims quietly: a
far dock is seen in two frames of three, one that has moved out of reach in none."""

_LIKELY = 0.1  # of a manoeuvre: both models are tried
_SURE = 7.0  # natural logarithm of odds: no frame makes surer than a thousandth
_SUREST = 1 / (1 + math.exp(-_SURE))


def later(swift: float, elapsed_s: float) -> float:
    """Probability 0..1 of a manoeuvre ``elapsed_s`` after it was ``swift``."""
    return SELDOM + (swift - SELDOM) * math.exp(-elapsed_s / LASTS_S)


def missed(swift: float) -> float:
    """Probability 0..1 of a manoeuvre after a frame did not show the dock where it was expected:
    a vehicle that manoeuvres loses it MISSES times as often."""
    return min(MISSES * swift / (1 - swift + MISSES * swift), _SUREST)


def decided(
    predicted: Callable[[float], Bank], sight: Sight, swift: float
) -> tuple[Bank, float] | None:
    """After a frame: the bank by the likelier model, and the probability that the vehicle
    manoeuvres.

    Parameters
    ----------
    predicted : the bank at the frame's time of a vehicle that has manoeuvred since the frame
        before with probability 0..1.
    swift : that probability before the frame.

    None where the dock is beyond the gate of both.
    """
    quiet = predicted(0.0).seen(sight)
    if quiet is not None and swift < _LIKELY and quiet.misfit < SURPRISING:
        return quiet, swift
    hard = predicted(1.0).seen(sight)
    if hard is None:
        return None if quiet is None else (quiet, swift)
    if quiet is None:
        return hard, _SUREST
    odds = math.log(swift / (1 - swift)) + hard.log_likelihood - quiet.log_likelihood
    after = 1 / (1 + math.exp(-min(max(odds, -_SURE), _SURE)))
    return (hard if after > 0.5 else quiet), after
