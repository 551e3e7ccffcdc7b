"""How surely a pose's place is known, where the dock's tilt is not.

From afar the same places are a dock that faces the camera and one that is turned, smaller and so
nearer.  About the pose that fits best a normal error describes that poorly, and one that covers
the truth nearly always makes it seem less sure than it is.  So all tilts are tried: at each the
rest of the pose is fitted, and its posterior density is the likelihood of the places times the
prior, with what was fitted integrated by Laplace's method (as in ``placement``).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.many import normal_equations, rotation_vectors, rotations
from chromadock.geometry.pose import MIN_MARKERS, Estimate, Sighting
from chromadock.robust.frame.flux import Fluxes
from chromadock.robust.weigh.acceptance import share_beyond
from chromadock.robust.weigh.nearness import log_nearness
from chromadock.robust.weigh.placement import PosePrior

Real = NDArray[np.float64]

# Tilts are tried on a square lattice, in standard deviations of the prior's.
_REACH, _STEP = 2.6, 0.2
_ROUNDS = 2  # of Gauss and Newton: more change nothing, the tilt being held
_DAMPING = 1e-9  # of the trace of the information
_LEAST_TILTS = 4.0  # that count: fewer, and the lattice is too coarse to integrate on


def doubt_over_tilts(
    sighting: Sighting,
    told: Estimate,
    prior: PosePrior,
    judged: Real,
    fluxes: Fluxes | None = None,
) -> float | None:
    """Probability that a point of the dock is not where ``told`` has it, to
    ``acceptance.PLACE_TOLERANCE``; the point is ``judged`` (3,), metres, in the sighting's frame.
    ``fluxes``: of the markers, where they are known.

    None where the tilt is known so well that the lattice does not resolve it, or the markers are
    three, which leave open poses between which no tilts lie.
    """
    if len(sighting.pixels) <= MIN_MARKERS:
        return None
    R, t = _fitted(sighting, told, prior)
    ahead = np.isfinite(t).all(axis=1) & sighting.camera.optics.sees(t)
    if not ahead.any():
        return None
    R, t = R[ahead], t[ahead]
    information, _, chi_square = _normal_equations(sighting, R, t)
    log_density = -0.5 * (chi_square + np.linalg.slogdet(information)[1])
    turn = rotation_vectors(R @ prior.R_expected.T)
    log_density -= 0.5 * np.einsum("mi,ij,mj->m", turn, prior.R_information, turn)
    # Of places, as in PosePrior.log_density.
    log_density -= sighting.camera.optics.log_volume(t)
    log_density += log_nearness(fluxes, sighting.points_dock, R, t)
    weights = np.exp(log_density - log_density.max())
    weights /= weights.sum()
    if 1 / (weights**2).sum() < _LEAST_TILTS:
        return None
    arm = R @ judged
    t = t + arm
    sight = t / np.linalg.norm(t, axis=1, keepdims=True)
    # How far the point moves along the line of sight by x, y, z and by the turn about the normal.
    turned = np.einsum("mi,mi->m", sight, np.cross(R[:, :, 2], arm))
    by_each = np.column_stack([sight, turned])
    variance = np.einsum("mi,mij,mj->m", by_each, np.linalg.inv(information), by_each)
    return share_beyond(told.t + told.R @ judged, t, np.sqrt(variance), weights)


def _fitted(sighting: Sighting, told: Estimate, prior: PosePrior) -> tuple[Real, Real]:
    """(M, 3, 3) and (M, 3): at each tilt the pose that fits best."""
    steps = np.arange(-_REACH, _REACH + _STEP / 2, _STEP)
    tilts = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    turns = tilts @ np.linalg.cholesky(prior.R_covariance)[:, :2].T
    R = rotations(turns) @ _rolled(prior.R_expected, told.R)
    t = np.tile(told.t, (len(R), 1))
    for _ in range(_ROUNDS):
        information, gradient, _ = _normal_equations(sighting, R, t)
        step = -np.linalg.solve(information, gradient)[..., 0]
        t = t + step[:, :3]
        R = rotations(step[:, 3:] * R[:, :, 2]) @ R
    return R, t


def _normal_equations(sighting: Sighting, R: Real, t: Real) -> tuple[Real, Real, Real]:
    """(M, 4, 4) and (M, 4, 1): information, and half the gradient of chi-square, by the place and
    by the turn about the dock's normal; (M,) chi-square.  A pose that ran away stays where it is,
    with an infinite chi-square."""
    normal = normal_equations(sighting, R, t)
    # What the six coordinates of a pose do by those four.
    by = np.zeros((len(R), 6, 4))
    by[:, :3, :3], by[:, 3:, 3] = np.eye(3), R[:, :, 2]
    information = by.transpose(0, 2, 1) @ normal.information @ by
    gradient = by.transpose(0, 2, 1) @ normal.gradient[..., None]
    ran_away = ~(np.isfinite(information).all(axis=(1, 2)) & np.isfinite(gradient).all(axis=(1, 2)))
    information[ran_away], gradient[ran_away] = np.eye(4), 0.0
    chi_square = np.where(ran_away, np.inf, normal.chi_square)
    trace = np.trace(information, axis1=1, axis2=2)[:, None, None]
    return information + _DAMPING * trace * np.eye(4), gradient, chi_square


def _rolled(R_expected: Real, R: Real) -> Real:
    """(3, 3): ``R_expected`` turned about the camera's axis as ``R`` is."""
    turn = R @ R_expected.T
    roll = np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
    return np.asarray(rotations(np.array([[0.0, 0.0, roll]]))[0] @ R_expected)
