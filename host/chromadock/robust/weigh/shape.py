"""What a dock looks like to a camera that may hold it at any likely pose.

A constellation's shape is what is left of it when place, size and roll are taken away: with
two markers p and q as a base, marker m has the complex coordinate
``b_m = (z_m - z_p) / (z_q - z_p)`` (Bookstein, Statistical Science 1 (1986) 181).  Over likely
poses shapes are close to a normal distribution, if sizes are looked at apart; it is learnt
from simulated views and so holds for docks of any geometry.

Places are complex numbers x + iy in ideal pixels: focal length times the lens's ideal places
(see ``lens``), for a pinhole tangents, without distortion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.robust.frame.layout import finest_cell
from chromadock.robust.weigh.evidence import placed_along

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

ATTITUDE_RAD = np.radians([10.0, 23.0, 10.0])
"""Standard deviations of pitch, yaw and roll between dock and camera: a vehicle on its way
to the dock swims level and about along its axis."""

MIN_SPACING_CELLS = 2.0
"""Of the closest markers that are searched for at a scale, in its cells, which do not touch."""

FINEST_SPACING_CELLS = 3.0
"""The same at the finest scale, and of the farthest dock of interest: the lens merges what is
closer, and the strokes of a recorder's letters are 5 pixels apart."""

FACETS = 5
"""Ways to look at a dock: along its axis, and from the left, the right, above and below.  Seen
from near, one side of a turned dock looks larger than the other, which is another distribution
of shapes each way."""

_ALONG_AXIS = float(np.sin(np.radians(12.0)))

_VIEWS = 36_000  # half of them are whole, and an eighth of those falls in each of ...
_SPANS = 8  # ... as many spans of size: covariances to 8% in the rarest facet
_ROOM = 1.15  # of windows beyond all views
_TAIL = 0.001  # of the views may be shorter than a window


@dataclass(frozen=True, slots=True)
class Window:
    """Where displacements between two markers point: lengths, direction (a unit), spread.

    ``search_window_t`` in ``host/native/search.h`` is the same.
    """

    shortest: float
    longest: float
    direction: complex
    half_angle: float

    @classmethod
    def of(cls, displacements: Complex) -> Window:
        """The window that holds almost all of (N,) displacements."""
        mean = displacements.mean()
        direction = complex(mean / abs(mean))
        turned = np.abs(np.angle(displacements / direction))
        shortest, longest = np.quantile(np.abs(displacements), [_TAIL, 1.0])
        half_angle = min(_ROOM * float(turned.max()), 1.4)
        return cls(float(shortest) / _ROOM, float(longest) * _ROOM, direction, half_angle)

    def beyond(self, length: float) -> Window:
        """Without what is shorter."""
        return replace(self, shortest=max(self.shortest, length))


@dataclass(frozen=True, slots=True)
class ShapeModel:
    """Distribution of the views of n markers.

    ``order`` (n,): which markers p, q, the third, ... are; ``along`` (n,): see
    ``evidence.placed_along``, in that order.  ``base`` and ``side``: windows of
    q and of the third as seen from p.  ``roll_rad``: standard deviation of the base's
    direction.  ``edges`` (S-1,): sizes |z_q - z_p| between the spans.  ``mean`` (S, 2n-4) and
    ``covariance`` (S, 2n-4, 2n-4): of Re b_3, Im b_3, Re b_4, ... in each.
    """

    order: tuple[int, ...]
    along: Real
    base: Window
    side: Window
    roll_rad: float
    edges: Real
    log_share: Real
    mean: Real
    covariance: Real

    @classmethod
    def learn(cls, points: Real, camera: CameraModel) -> ShapeModel:
        """Simulate views of (n, 3) markers; the same for the same markers and camera."""
        return _learnt(np.ascontiguousarray(points, np.float64).tobytes(), camera.key)

    @classmethod
    def _of(cls, points: Real, camera: CameraModel) -> ShapeModel:
        order = _order(points)
        z, facet = _views(points[list(order)], camera)
        base, side = z[:, 1] - z[:, 0], z[:, 2] - z[:, 0]
        shape = stacked((z[:, 2:] - z[:, :1]) / base[:, None])
        edges = np.quantile(np.abs(base), np.arange(1, _SPANS) / _SPANS)
        span = np.searchsorted(edges, np.abs(base)) * FACETS + facet
        window = Window.of(base)
        share = np.bincount(span, minlength=_SPANS * FACETS).reshape(_SPANS, FACETS)
        parts = [_of_class(shape, span, s) for s in range(_SPANS * FACETS)]
        with np.errstate(divide="ignore"):  # a facet that is never seen
            log_share = np.log(share / share.sum(axis=1, keepdims=True))
        return cls(
            order=order,
            along=placed_along(points)[list(order)],
            base=window,
            side=Window.of(side),
            roll_rad=float(np.angle(base / window.direction).std()),
            edges=edges,
            log_share=log_share.ravel(),
            mean=np.array([part.mean(axis=0) for part in parts]),
            covariance=np.array([np.cov(part.T) for part in parts]),
        )

    def log_base(self, base: Complex) -> Real:
        """Log density of (N,) bases, a square pixel: even in log size, normal in direction."""
        angle = np.angle(base / self.base.direction) / self.roll_rad
        spread = np.log(self.base.longest / self.base.shortest) * self.roll_rad
        return np.asarray(
            -0.5 * angle**2 - np.log(spread * np.sqrt(2 * np.pi)) - 2 * np.log(np.abs(base))
        )

    def log_shape(self, z: Complex, sigma_px: Real) -> Real:
        """(N,) log density of sets of markers at ``z`` (N, n), known to ``sigma_px`` (N, n),
        given their bases: in square pixels to the power n - 2; both in the shape's order.
        """
        base = z[:, 1] - z[:, 0]
        size = np.abs(base)
        b = (z[:, 2:] - z[:, :1]) / base[:, None]
        # b moves by (dz_m - (1 - b) dz_p - b dz_q) / base.
        by_p, by_q = (1 - b) * sigma_px[:, :1], b * sigma_px[:, 1:2]
        known = by_p[:, :, None] * by_p.conj()[:, None] + by_q[:, :, None] * by_q.conj()[:, None]
        known += sigma_px[:, 2:, None] ** 2 * np.eye(b.shape[1])
        span = np.searchsorted(self.edges, size)[:, None] * FACETS + np.arange(FACETS)
        covariance = self.covariance[span] + _as_real(known / size[:, None, None] ** 2)[:, None]
        off = stacked(b)[:, None] - self.mean[span]
        square = (off * np.linalg.solve(covariance, off[..., None])[..., 0]).sum(axis=2)
        log_norm = 0.5 * np.linalg.slogdet(2 * np.pi * covariance)[1]
        facets = self.log_share[span] - 0.5 * square - log_norm
        return np.asarray(np.logaddexp.reduce(facets, axis=1) - 2 * b.shape[1] * np.log(size))


@lru_cache(maxsize=32)
def _learnt(points: bytes, key: tuple[int, int, bytes, bytes, str]) -> ShapeModel:
    """The model of a dock and a camera: a second detector need not learn it again."""
    return ShapeModel._of(np.frombuffer(points).reshape(-1, 3), CameraModel.of_key(key))


def stacked(values: Complex) -> Real:
    """(N, m) complex to (N, 2m) real: Re, Im, Re, Im, ..."""
    return np.ascontiguousarray(values).view(np.float64)


def _as_real(matrices: Complex) -> Real:
    """(N, m, m) complex, that act on m complex numbers, to what they do to ``stacked`` ones."""
    count, size, _ = matrices.shape
    blocks = matrices[:, :, None, :, None] * np.array([[1, 1j], [-1j, 1]])[:, None]
    return np.asarray(blocks.real.reshape(count, 2 * size, 2 * size), np.float64)


def ideal(pixels: Real, camera: CameraModel) -> Complex:
    """(N, 2) pixels to (N,) places without the lens's distortion."""
    places = focal_px(camera) * camera.optics.ideal(pixels)
    return np.ascontiguousarray(places).view(np.complex128).ravel()


def focal_px(camera: CameraModel) -> float:
    """Focal length: the geometric mean of both axes'."""
    return float(np.sqrt(camera.matrix[0, 0] * camera.matrix[1, 1]))


def _order(points: Real) -> tuple[int, ...]:
    """The widest pair, from the end that has the nearer neighbour; then by nearness to it."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    ends = [int(i) for i in np.unravel_index(apart.argmax(), apart.shape)]
    others = [m for m in range(len(points)) if m not in ends]
    p = min(ends, key=lambda end: float(apart[end, others].min()))
    q = ends[1 - ends.index(p)]
    others.sort(key=lambda m: float(apart[p, m]))
    return (p, q, *others)


def _views(points: Real, camera: CameraModel) -> tuple[Complex, NDArray[np.intp]]:
    """(V, n) places of the markers in views that the camera sees whole, and the facet of each."""
    rng, optics = np.random.default_rng(0), camera.optics
    corners = optics.ideal(np.array([(0.0, 0.0), (camera.width - 1.0, camera.height - 1.0)]))
    low, high = corners.min(axis=0), corners.max(axis=0)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    nearest = float(apart.max() / np.linalg.norm(high - low))
    farthest = focal_px(camera) * float(apart[apart > 0].min())
    farthest /= FINEST_SPACING_CELLS * finest_cell(camera.width, camera.height)
    # Even in log range; a camera too coarse for this dock still gets views at twice the nearest.
    ranges = nearest * max(farthest / nearest, 2.0) ** rng.random(_VIEWS)
    centres = optics.rays_of(rng.uniform(low, high, (_VIEWS, 2))) * ranges[:, None]
    R = _rotations(rng.standard_normal((_VIEWS, 3)) * ATTITUDE_RAD)
    seen = np.einsum("vij,nj->vni", R, points) + centres[:, None]
    in_view = optics.sees(seen).all(axis=1)
    places = optics.ideal_of(seen[in_view])
    whole = ((places > low) & (places < high)).all(axis=(1, 2))
    z = focal_px(camera) * (places[whole] @ np.array([1, 1j]))
    return np.asarray(z), _facets(R[in_view][whole], centres[in_view][whole])


def _of_class(shape: Real, span: NDArray[np.intp], which: int) -> Real:
    """Shapes (N, 2n-4) of a span and facet, or where these are too few for a covariance, as of a
    dock that is seen whole from near alone, of the span, or of all."""
    least = shape.shape[1] + 2
    choices = (shape[span == which], shape[span // FACETS == which // FACETS])
    return next((part for part in choices if len(part) >= least), shape)


def _facets(R: Real, centres: Real) -> NDArray[np.intp]:
    """(V,) from which side (V, 3, 3) docks are seen at (V, 3) places."""
    sight = centres / np.linalg.norm(centres, axis=1, keepdims=True)
    normal = R[:, :, 2]
    x, y, _ = (normal - (normal * sight).sum(axis=1, keepdims=True) * sight).T
    turned = np.where(np.abs(x) > np.abs(y), np.where(x > 0, 1, 2), np.where(y > 0, 3, 4))
    return np.where(np.hypot(x, y) < _ALONG_AXIS, 0, turned)


def _rotations(angles: Real) -> Real:
    """(V, 3, 3) rotations by (V, 3) angles about x, then y, then z of the turned axes."""
    product = np.eye(3)
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        turn = np.tile(np.eye(3), (len(angles), 1, 1))
        cosine, sine = np.cos(angles[:, axis]), np.sin(angles[:, axis])
        turn[:, a, a], turn[:, a, b], turn[:, b, a], turn[:, b, b] = cosine, -sine, sine, cosine
        product = product @ turn
    return product
