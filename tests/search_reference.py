"""The search for constellations written the plain way: slow, and owing nothing to the C.

Every ordered set of peaks is looked at; densities are those of textbooks, of matrices as large as
they come.
"""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np

from chromadock.robust.frame.peaks import MAX_PEAKS, MIN_SNR, NEIGHBOURHOOD, Peaks
from chromadock.robust.weigh import chroma, clutter, evidence
from chromadock.robust.weigh.shape import FACETS, ShapeModel, Window

GATE_OF_FEW, GATE_OF_MANY, FEW = 40.0, 18.0, 5
VAST = 1e7
"""Variance of a common strength of which next to nothing is known."""


def sets_of(
    model: ShapeModel, sigma_px: float, area: float, z: np.ndarray, peaks: Peaks, least: float
) -> dict[tuple[int, ...], float]:
    """The evidence of every set, by its members in the dock's order, that has ``least``."""
    found = {}
    for members in permutations(peaks.promising.tolist(), len(model.order)):
        place = log_places(model, sigma_px, z[list(members)])
        if place is None:
            continue
        looks = log_looks(z, peaks, area, members, model.along)
        if place - math.log(area) + looks >= least:
            named = tuple(int(members[k]) for k in np.argsort(model.order))
            found[named] = place - math.log(area) + looks
    return found


def log_places(model: ShapeModel, sigma_px: float, z: np.ndarray) -> float | None:
    """Log density of markers' places given the first one's, of the facet where it is largest;
    None where they stand as no dock's do.
    """
    base = z[1] - z[0]
    size, slack = abs(base), 2 * sigma_px
    if not (inside(model.base, base, slack) and inside(model.side, z[2] - z[0], slack)):
        return None
    edges = [model.base.shortest, *model.edges, model.base.longest]
    span = sum(size > edge for edge in model.edges)
    noise = 1.5 * sigma_px**2 / (edges[span] * edges[span + 1])
    b = (z[2:] - z[0]) / base
    shape = np.column_stack([b.real, b.imag]).ravel()
    best = None
    for facet in range(FACETS):
        k = span * FACETS + facet
        off, covariance = shape - model.mean[k], model.covariance[k] + noise * np.eye(len(shape))
        if passes(off, covariance):
            density = log_normal(off, covariance) + model.log_share[k]
            best = density if best is None else max(best, density)
    if best is None:
        return None
    angle = np.angle(base / model.base.direction) / model.roll_rad
    spread = math.log(model.base.longest / model.base.shortest)
    bases = -0.5 * angle**2 - math.log(model.roll_rad * math.sqrt(2 * math.pi) * spread)
    return float(best + bases - 2 * (len(z) - 1) * math.log(size))


def passes(off: np.ndarray, covariance: np.ndarray) -> bool:
    """Whether each marker adds less than the gate to chi-square, given those before it."""
    before, gate = 0.0, GATE_OF_FEW if len(off) // 2 + 2 <= FEW else GATE_OF_MANY
    for m in range(2, len(off) + 1, 2):
        square = float(off[:m] @ np.linalg.solve(covariance[:m, :m], off[:m]))
        if square - before >= gate:
            return False
        before = square
    return True


def inside(window: Window, d: complex, slack: float) -> bool:
    turned = d / window.direction
    return (
        window.shortest - slack < abs(d) < window.longest + slack
        and abs(turned.imag) < math.tan(window.half_angle) * turned.real + slack
    )


def log_normal(off: np.ndarray, covariance: np.ndarray) -> float:
    square = off @ np.linalg.solve(covariance, off)
    return float(-0.5 * (square + np.linalg.slogdet(2 * np.pi * covariance)[1]))


def log_looks(
    z: np.ndarray, peaks: Peaks, area: float, members: tuple[int, ...], along: np.ndarray
) -> float:
    """All that has nothing to do with where a set's members are."""
    others = [i for i in range(len(z)) if i not in members]
    # The looks of the clutter in this frame, and of eight peaks of clutter of all kinds.
    usual = [*np.exp(peaks.likeness[others]), *[1.0] * int(clutter.LOOKS_SUPPOSED)]
    return (
        log_alike(peaks.snr[list(members)], along)
        + float(peaks.likeness[list(members)].sum())
        - len(members) * math.log(np.mean(usual))
        + sum(rarity(z, peaks, area, m, others) for m in members)
        + log_common(z, peaks, area, members, others)
    )


def log_alike(snr: np.ndarray, along: np.ndarray) -> float:
    """A normal density whose covariance has the common value's and the slope's variance in it."""
    values = np.log(snr)
    covariance = np.diag(evidence.SPREAD**2 + 1 / snr**2)
    covariance += evidence.SLOPE**2 * np.outer(along, along) + VAST
    even = math.log(math.sqrt(2 * np.pi * VAST) / math.log(evidence.STRONGEST / MIN_SNR))
    return log_normal(values - values.mean(), covariance) + even


def near(z: np.ndarray, area: float, a: int, b: int) -> bool:
    return bool(abs(z[a] - z[b]) < NEIGHBOURHOOD * math.sqrt(area))


def rarity(z: np.ndarray, peaks: Peaks, area: float, m: int, others: list[int]) -> float:
    """Minus log density of clutter at one peak, if ``others`` are clutter."""
    snr = peaks.snr
    least = snr[-1] if len(snr) == MAX_PEAKS else MIN_SNR
    height = [max(math.log(s / least), 0.0) for s in snr]
    a = clutter.SUPPOSED + len(others)
    b = clutter.SUPPOSED / clutter.EXPONENT + sum(height[i] for i in others)
    stronger = sum(i < m for i in others)
    nearby = sum(i < m and near(z, area, i, m) for i in others)
    expected = stronger + 1.0
    if stronger == 0:
        strongest = max((height[i] for i in others), default=0.0)
        fall = ((b + strongest) / (b + height[m])) ** a
        expected = min(max(fall, clutter.MOST_FALL), 1.0)
    disc = math.pi * NEIGHBOURHOOD**2 * area * float(peaks.inside[m])
    return -math.log(a / (b + height[m]) * (nearby + 1) / (disc + area / expected))


def log_common(
    z: np.ndarray, peaks: Peaks, area: float, members: tuple[int, ...], others: list[int]
) -> float:
    """Log likelihood ratio that members have one colour."""
    x = peaks.chroma
    variance = chroma.SPREAD**2 + (chroma.NOISE / peaks.snr) ** 2
    density = [
        [student(x[i] - x[j], variance[i] + variance[j]) for j in members] for i in range(len(x))
    ]
    clutters = []
    for k, j in enumerate(members):
        beside = [density[i][k] for i in others if near(z, area, i, j)]
        supposed = chroma.SUPPOSED * student(x[j], chroma.WIDE**2 + variance[j])
        everywhere = sum(density[i][k] for i in others) + supposed
        everywhere /= len(others) + chroma.SUPPOSED
        clutters.append(
            (sum(beside) + chroma.SUPPOSED * everywhere) / (len(beside) + chroma.SUPPOSED)
        )
    ratios = []
    for i in members:
        ratio = 1.0
        for k, j in enumerate(members):
            if i != j:
                alike = density[i][k] / clutters[k]
                ratio *= (1 - chroma.DISTURBED) * alike + chroma.DISTURBED
        ratios.append(ratio)
    return math.log(np.mean(ratios))


def student(off: np.ndarray, variance: float) -> float:
    """Student's distribution in the plane with two degrees of freedom: (1 + r^2 / 2)^-2 / 2 pi,
    of r scaled by ``variance``."""
    return float((1 + off @ off / (2 * variance)) ** -2 / (2 * math.pi * variance))
