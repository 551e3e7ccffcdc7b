"""Which markers are the nearer ones, by how bright they are.

From afar a dock that is turned one way looks as if it were turned the other way, and three markers
leave up to four poses open.  These differ in which markers are nearer; and since all lamps of a
dock shine alike, more light arrives of a nearer one: by the square of the range, and by what the
water takes on the way.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.flux import Fluxes

Real = NDArray[np.float64]

EXPONENT, EXPONENT_SPREAD = 2.0, 0.7
"""The flux falls as this power of the range, known to a standard deviation.  In drawn scenes of the
half that was developed on it is 1.5 at 0.7 m, where lamps are overexposed, and 2.9 at 3 m, through
water; of lamps that shine ahead rather than to all sides it is more by one or two."""

SPREAD = 0.25
"""Standard deviation of the log flux of one dock's lamps: LEDs, windows and holders differ.  In the
same scenes it is 0.15, in part by what was drawn for them; how it is of real docks nobody has
measured, so that more is allowed."""

FREEDOM = 3.0
"""Degrees of freedom of the t-distribution that the deviations are supposed to have: one lamp in
twenty, before a bar or something bright, is off by 0.5 or more."""


def log_nearness(fluxes: Fluxes | None, points_dock: Real, R: Real, t: Real) -> Real:
    """(M,) natural log of the density of the fluxes of markers at poses (M, 3, 3), (M, 3), up to a
    constant that all have in common; 0 where the fluxes are not known.

    The density is a multivariate t-distribution about a common flux of which nothing is known,
    which falls with the range by an exponent that is normally distributed (Gelman et al., Bayesian
    Data Analysis, 2013, section 3.2 and chapter 17).

    Parameters
    ----------
    points_dock : (n, 3) metres, the markers.
    """
    if fluxes is None:
        return np.zeros(len(t))
    range_m = np.linalg.norm(points_dock @ R.transpose(0, 2, 1) + t[:, None], axis=2)
    precision = 1 / (SPREAD**2 + fluxes.sigma**2)
    share = precision / precision.sum()
    farther = np.log(range_m)
    farther -= (farther @ share)[:, None]
    off = fluxes.log + EXPONENT * farther
    off -= (off @ share)[:, None]
    by_exponent = EXPONENT_SPREAD**2 * (farther**2 @ precision)
    explained = EXPONENT_SPREAD**2 * ((farther * off) @ precision) ** 2 / (1 + by_exponent)
    square = off**2 @ precision - explained
    fit = -0.5 * (FREEDOM + len(share) - 1) * np.log1p(square / FREEDOM)
    return np.asarray(fit - 0.5 * np.log1p(by_exponent))
