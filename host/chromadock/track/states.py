"""How sure the track is of the dock: states and when they change."""

from __future__ import annotations

TRACKING_S = 0.3
"""A dock seen within this is tracked: as long as a camera of 10 Hz takes for three frames.
The prediction is good to centimetres still: 0.3 s of ACCELERATION are 3 cm."""

KEPT_S = 2.5
"""After this nothing is expected any more.  By then place is uncertain by 0.7 m: as wide as the
dock, so that where it was says no more than a search of the whole frame finds."""

MOST_DOUBT = 0.02
"""Probability that the place is off by more than 5 % of the range, beyond which a dock that was
locked has no pose yet.  Less than for a single frame (``robust.weigh.acceptance``): what is wrong
with one frame of a track is wrong with those after it too."""

MOST_ELSEWHERE = 0.005
"""Of that, what other poses may have that would put it elsewhere: which of several poses is the
right one is told by little but how the vehicle moves, and the wrong one, once taken, stays for
seconds.  Above ``bank.FORGOTTEN``, below which a pose that a frame leaves open comes back."""

MOST_DOUBT_KEPT = 0.15
"""The same of one that has a pose and was just measured: with a marker out it is known less well,
but what was right before is not suddenly elsewhere."""

MOST_DOUBT_UNSEEN = 0.3
"""The same of one that had a pose when it was last measured: out of sight it is known less well
every moment."""

STATES = ("never_seen", "acquiring", "tracking", "recently_lost", "lost")


def state_of(age_s: float | None, candidate: bool, seen: bool) -> str:
    """One of ``STATES``.

    Parameters
    ----------
    age_s : since a locked dock was last measured; None without a locked one.
    candidate : whether there is a dock that may become locked.
    seen : whether any was locked before.
    """
    if age_s is not None and age_s <= KEPT_S:
        return "tracking" if age_s <= TRACKING_S else "recently_lost"
    if candidate:
        return "acquiring"
    return "lost" if seen else "never_seen"
