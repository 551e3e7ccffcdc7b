"""The halo of a lamp: light that water scattered by small angles, several times over.

Wells, W. H. (1969), "Loss of resolution in water as a result of multiple small-angle
scattering", J. Opt. Soc. Am. 59, 686-691: along a path of tau = b r the transfer function
is exp(-tau + tau Q(psi)), Q(psi) = (1/psi) * integral of p~ from 0 to psi, p~ the Hankel
transform of the phase function. Divided by the unscattered exp(-tau), the halo is
exp(tau Q) - 1. Q is the transform of what single scattering shows the camera, so the
exponential of a transform is here taken as what it stands for, a sum of convolutions of
rings: all numbers stay positive over ten decades, where an inverse transform cancels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import overload

import numpy as np

from chromadock.sim.phase import PhaseFunction
from chromadock.sim.spectrum import FloatArray

MAX_ANGLE_RAD = math.pi / 2
"""Scattering backwards counts as lost.

A smaller limit loses light that belongs to the halo: what is turned by a large angle near the
lamp reaches the camera at a small one. Scattered once it arrives there as the theory has it at
any angle, but for its longer path: along a line of sight, ds / distance^2 to the lamp is
dtheta / (r sin(gamma)), for theta the scattering angle and gamma that at the camera.
"""

_INNERMOST_RAD = 2e-4
_RINGS = 128

_SMALLEST_TAU = 0.01
_DOUBLINGS = 12
_PER_DOUBLING = 6
"""tau is tabulated at 0.01 * 2^(k/6) up to 36."""


@dataclass(frozen=True, eq=False)
class HaloTable:
    """The halo's energy and shape for a phase function, over tau = b r.

    Angles are between a ray's direction at the camera and the direction to the lamp.
    """

    phase: PhaseFunction
    forward_share: float = field(init=False)
    """Q(0): the share of scattered light within `MAX_ANGLE_RAD`."""
    edges_rad: FloatArray = field(init=False, repr=False)
    """(n+1,) borders of the rings, from 0."""
    angles_rad: FloatArray = field(init=False, repr=False)
    """(n,) the rings' root mean square radii: 0.14 mrad to nearly `MAX_ANGLE_RAD`."""
    _log_tau: FloatArray = field(init=False, repr=False)
    _log_density: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        edges, angles, log_tau, log_density = _tables(self.phase.station)
        object.__setattr__(self, "forward_share", float(self.phase.share_within(MAX_ANGLE_RAD)))
        object.__setattr__(self, "edges_rad", edges)
        object.__setattr__(self, "angles_rad", angles)
        object.__setattr__(self, "_log_tau", log_tau)
        object.__setattr__(self, "_log_density", log_density)

    @overload
    def share(self, tau: float) -> float: ...

    @overload
    def share(self, tau: FloatArray) -> FloatArray: ...

    def share(self, tau: float | FloatArray) -> float | FloatArray:
        """Energy of the halo per unscattered energy at the camera: exp(tau Q(0)) - 1."""
        halo = np.expm1(self.forward_share * np.asarray(tau))
        return float(halo) if np.ndim(tau) == 0 else halo

    def density(self, tau: float) -> FloatArray:
        """(n,) the halo's energy per solid angle, sr^-1, at `angles_rad`.

        Summed over the rings' areas pi (edges[1:]^2 - edges[:-1]^2) it is 1. Outside the
        table, 0.01 to 36, the shape is that at its end: below it no longer changes, above
        nothing is left of a lamp.
        """
        rows = np.arange(len(self._log_tau))
        place = float(np.interp(math.log(max(tau, _SMALLEST_TAU)), self._log_tau, rows))
        below = min(int(place), len(rows) - 2)
        lower, upper = self._log_density[below : below + 2]
        density = np.exp(lower + (place - below) * (upper - lower))
        return np.asarray(density / (density @ _areas(self.edges_rad)))


@cache
def _tables(station: str) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Edges, angles, log tau (k,) and log density (k, n) of a station."""
    rings = np.geomspace(_INNERMOST_RAD, MAX_ANGLE_RAD, _RINGS)
    edges = np.concatenate([[0.0], rings])
    angles = np.sqrt((edges[1:] ** 2 + edges[:-1] ** 2) / 2)
    single = np.diff(_single_scattering(PhaseFunction.of(station), edges))
    kernel = _sum_of_directions(angles, edges)
    rows: dict[float, FloatArray] = {}
    for part in range(_PER_DOUBLING):
        tau = _SMALLEST_TAU * 2 ** (part / _PER_DOUBLING)
        halo = tau * single + tau**2 / 2 * _convolved(kernel, single, single)
        for _ in range(_DOUBLINGS):
            rows[tau] = halo / halo.sum()
            # (1 + halo)^2 = 1 + 2 halo + halo * halo: twice the path, still without its 1
            halo = 2 * halo + _convolved(kernel, halo, halo)
            tau *= 2
    taus = np.array(sorted(rows))
    density = np.stack([rows[tau] for tau in taus]) / _areas(edges)
    return edges, angles, np.log(taus), np.log(density)


def _single_scattering(phase: PhaseFunction, angle_rad: FloatArray) -> FloatArray:
    """Energy within each angle at the camera after one scattering, per tau.

    Light of a point that is scattered by theta at the share u of the way to the camera
    arrives at u theta, and u is uniform: E(alpha) = integral over u of S(min(alpha / u, max)).
    """
    u = (np.arange(4000) + 0.5) / 4000
    scattered = np.minimum(angle_rad[:, None] / u, MAX_ANGLE_RAD)
    return np.asarray(phase.share_within(scattered).mean(axis=1))


def _sum_of_directions(angles: FloatArray, edges: FloatArray) -> FloatArray:
    """(n, n, n): how two deflections of radii i and j, freely turned, share out over rings k.

    |p + q|^2 = p^2 + q^2 + 2 p q cos(phi) with phi uniform.
    """
    p, q = angles[:, None, None], angles[None, :, None]
    cosine = (edges**2 - p**2 - q**2) / (2 * p * q)
    within = 1 - np.arccos(np.clip(cosine, -1, 1)) / math.pi
    within[..., -1] = 1.0  # the outermost ring keeps what goes beyond, so no energy is lost
    return np.asarray(np.diff(within, axis=-1))


def _convolved(kernel: FloatArray, p: FloatArray, q: FloatArray) -> FloatArray:
    return np.asarray(np.outer(p, q).reshape(-1) @ kernel.reshape(-1, kernel.shape[-1]))


def _areas(edges: FloatArray) -> FloatArray:
    """(n,) solid angles of the rings in the small-angle plane, sr."""
    return np.asarray(math.pi * np.diff(edges**2))
