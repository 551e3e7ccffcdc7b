"""How far a pose's attitude can truly go: the covariance beyond the linear one.

From afar a plane's tilt shows in its places only by second order, so that the curvature of
chi-square at its minimum says little about where the true tilt may be.  The profile does:
chi-square along a turn with all else refitted (Venzon and Moolgavkar, Applied Statistics 37
(1988) 87).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.many import normal_equations, rotation_vectors, rotations
from chromadock.geometry.pose import Estimate, Sighting

_WELL_KNOWN_RAD = 0.015
"""Standard deviation of a turn below which second order is far below first."""

# Turns that are tried, in linear standard deviations, and the most.
_TURNS = np.array([-8.0, -4.0, -2.0, 2.0, 4.0, 8.0])
_MOST_TURN_RAD = 0.7
_TILTS = 2  # a plane's; the third turn, roll, is seen directly
_ROUNDS = 2  # of refitting
_STIFFNESS, _DAMPING = 1e6, 1e-10  # of the turn that is held and of all: traces of the information
_RAN_AWAY = 1e8  # times the information: a marker is ten thousand times nearer than it was
_REGION = 12.6  # chi-square with six degrees of freedom, 95%: farther turns do not count
_LEAST_RISE = 4.0  # two standard deviations: what rises less says no more than that it may be true


def widened(sighting: Sighting, estimate: Estimate) -> Estimate:
    """The estimate with an information that admits every attitude which the markers do.

    Unchanged where the markers tell the attitude well.
    """
    information = estimate.information
    by_turn = np.linalg.solve(information[:3, :3], information[:3, 3:])
    turns = information[3:, 3:] - information[3:, :3] @ by_turn
    steepness, axes = np.linalg.eigh(turns)
    sigmas = 1 / np.sqrt(np.maximum(steepness[:_TILTS], 1e-12))
    if not sigmas[0] >= _WELL_KNOWN_RAD:
        return estimate
    angles = np.minimum(sigmas[:, None] * _TURNS, _MOST_TURN_RAD).ravel()
    along = np.repeat(axes.T[:_TILTS], _TURNS.size, axis=0)
    steps, chi_square = _profile(sighting, estimate, along, angles)
    rise = np.maximum(chi_square - estimate.chi_square, _LEAST_RISE)
    covariance = estimate.covariance
    for step, allowed in zip(steps[rise < _REGION], rise[rise < _REGION], strict=True):
        now = float(step @ np.linalg.solve(covariance, step))
        if now > allowed:
            # By Sherman and Morrison the step's distance becomes what is allowed.
            covariance = covariance + (1 / allowed - 1 / now) * np.outer(step, step)
    return replace(estimate, information=np.asarray(np.linalg.inv(covariance), np.float64))


def _profile(
    sighting: Sighting,
    estimate: Estimate,
    axes: NDArray[np.float64],
    angles: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Steps (M, 6) away and chi-square (M,) after turns by ``angles`` (M,) about ``axes``
    (M, 3), units, all else refitted.  A refit that ran away, until a marker was next to the lens,
    has an infinite chi-square."""
    R = rotations(angles[:, None] * axes) @ estimate.R
    t = np.tile(estimate.t, (len(angles), 1))
    # Along the axis a refit must not turn: there it is held as by a very good measurement.
    held = np.zeros((len(angles), 6, 6))
    held[:, 3:, 3:] = axes[:, :, None] * axes[:, None, :]
    most = _RAN_AWAY * float(np.trace(estimate.information))
    lost = np.zeros(len(angles), bool)
    for _ in range(_ROUNDS):
        information, gradient, *_ = normal_equations(sighting, R, t)
        lost |= ~(np.trace(information, axis1=1, axis2=2) < most)
        information[lost], gradient[lost] = np.eye(6), 0.0
        trace = np.trace(information, axis1=1, axis2=2)[:, None, None]
        damped = information + trace * (_STIFFNESS * held + _DAMPING * np.eye(6))
        step = -np.linalg.solve(damped, gradient[..., None])[..., 0]
        t = t + step[:, :3]
        R = rotations(step[:, 3:]) @ R
    turned = rotation_vectors(R @ estimate.R.T)
    chi_square = np.where(lost, np.inf, normal_equations(sighting, R, t).chi_square)
    return np.column_stack([t - estimate.t, turned]), chi_square
