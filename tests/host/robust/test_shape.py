from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from search_reference import inside

from chromadock import CameraModel, DockGeometry
from chromadock.robust.frame.layout import finest_cell
from chromadock.robust.weigh.shape import FACETS, FINEST_SPACING_CELLS, ShapeModel, ideal

CAMERA = CameraModel.nominal(640, 480)
RECTANGLE = DockGeometry.default().points
FIVE = np.vstack([RECTANGLE, (0.0, 0.0, -0.3)])
THREE = np.array([(-0.5, 0.2, 0.0), (0.6, 0.1, 0.1), (0.0, -0.4, -0.2)])
DOCKS = [RECTANGLE, FIVE, THREE]


def seen_from(points: np.ndarray, range_m: float, seed: int, camera: CameraModel = CAMERA):
    """Places of a dock at a likely attitude, (n,) complex."""
    rng = np.random.default_rng(seed)
    pitch, yaw, roll = np.radians(rng.uniform(-1, 1, 3) * (8, 20, 8))
    c, s = np.cos, np.sin
    about_x = np.array([[1, 0, 0], [0, c(pitch), -s(pitch)], [0, s(pitch), c(pitch)]])
    about_y = np.array([[c(yaw), 0, s(yaw)], [0, 1, 0], [-s(yaw), 0, c(yaw)]])
    about_z = np.array([[c(roll), -s(roll), 0], [s(roll), c(roll), 0], [0, 0, 1]])
    t = range_m * np.array([rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), 1])
    return ideal(camera.project(points @ (about_x @ about_y @ about_z).T + t), camera)


@pytest.mark.parametrize("points", DOCKS)
def test_the_base_is_the_widest_pair_and_the_third_stands_nearest(points: np.ndarray) -> None:
    model = ShapeModel.learn(points, CAMERA)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    p, q, third, *rest = model.order
    assert apart[p, q] == apart.max()
    assert sorted(model.order) == list(range(len(points)))
    assert all(apart[p, third] <= apart[p, m] for m in rest)


# How far one marker is moved, by the base's length.  The shape of three markers is one complex
# number, which views alone spread by a fifth: a triangle must be bent more to look unlikely.
@pytest.mark.parametrize(("points", "bent"), [(RECTANGLE, 0.25), (FIVE, 0.25), (THREE, 0.75)])
def test_likely_docks_look_likely_and_deformed_ones_do_not(points: np.ndarray, bent: float) -> None:
    model = ShapeModel.learn(points, CAMERA)
    order = list(model.order)
    sigma = np.full(len(points), 0.5)
    rng = np.random.default_rng(0)
    for range_m in (1.5, 3.0, 4.5):
        for seed in range(20):
            z = seen_from(points, range_m, seed)[order]
            off = z.copy()
            off[2] += bent * abs(z[1] - z[0]) * np.exp(2j * np.pi * rng.random())
            likely, unlikely = model.log_shape(np.array([z, off]), np.array([sigma, sigma]))
            assert likely > unlikely + 3
            assert inside(model.base, z[1] - z[0], 1.0)
            assert inside(model.side, z[2] - z[0], 1.0)


def test_the_density_of_bases_is_one_in_all() -> None:
    model = ShapeModel.learn(RECTANGLE, CAMERA)
    lengths = np.geomspace(model.base.shortest, model.base.longest, 400)
    angles = np.linspace(-np.pi, np.pi, 721)[:-1]
    bases = model.base.direction * lengths[:, None] * np.exp(1j * angles)
    density = np.exp(model.log_base(bases.ravel())).reshape(bases.shape)
    by_angle = density.mean(axis=1) * 2 * np.pi * lengths
    total = ((by_angle[1:] + by_angle[:-1]) / 2 * np.diff(lengths)).sum()
    assert total == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize("points", DOCKS)
def test_the_density_of_shapes_is_one_in_all(points: np.ndarray) -> None:
    """Importance sampling: the mean of density over proposal is the integral."""
    model = ShapeModel.learn(points, CAMERA)
    z = seen_from(points, 3.0, 4)[list(model.order)]
    sigma = np.full(len(points), 1.0)
    size = abs(z[1] - z[0])
    facets = np.searchsorted(model.edges, size) * FACETS + np.arange(FACETS)
    rng = np.random.default_rng(1)
    width = model.mean.shape[1]
    wide = 2.0 * model.covariance[facets] + 8 * (1 / size) ** 2 * np.eye(width)
    share = np.exp(model.log_share[facets])
    ratios = []
    for facet in rng.choice(FACETS, 4000, p=share):
        shape = rng.multivariate_normal(model.mean[facets[facet]], wide[facet])
        off = shape - model.mean[facets]
        square = (off * np.linalg.solve(wide, off[..., None])[..., 0]).sum(axis=1)
        norm = np.sqrt(np.linalg.det(2 * np.pi * wide))
        proposal = (share * np.exp(-0.5 * square) / norm).sum() / size**width
        markers = np.concatenate([z[:2], z[0] + shape.view(np.complex128) * (z[1] - z[0])])
        ratios.append(np.exp(model.log_shape(markers[None], sigma[None])[0]) / proposal)
    assert np.mean(ratios) == pytest.approx(1, abs=0.12)


def test_errors_of_places_spread_shapes_as_computed() -> None:
    """Against repeated disturbance of the places, where views themselves hardly differ."""
    model = ShapeModel.learn(RECTANGLE, CAMERA)
    z = seen_from(RECTANGLE, 3.0, 2)[list(model.order)]
    sigma = np.array([2.0, 0.3, 1.0, 0.5])
    rng = np.random.default_rng(3)
    noise = rng.standard_normal((20_000, 4)) + 1j * rng.standard_normal((20_000, 4))
    moved = z + 0.1 * sigma * noise
    b = (moved[:, 2:] - moved[:, :1]) / (moved[:, 1:2] - moved[:, :1])
    scatter = 100 * np.cov(np.ascontiguousarray(b).view(np.float64).T)
    exact = replace(
        model,
        mean=np.tile(b.mean(axis=0).view(np.float64), (len(model.mean), 1)),
        covariance=np.zeros_like(model.covariance),
    )
    at_mean = exact.log_shape(z[None], sigma[None])[0] + 4 * np.log(
        abs(z[1] - z[0])
    )  # a square pixel to one of b
    assert at_mean == pytest.approx(-0.5 * np.linalg.slogdet(2 * np.pi * scatter)[1], abs=0.1)


def test_places_do_not_depend_on_the_lens() -> None:
    bent = CameraModel(640, 480, CAMERA.matrix, np.array([-0.3, 0.1, 0.0, 0.0, 0.0]))
    assert seen_from(FIVE, 2.0, 5, bent) == pytest.approx(seen_from(FIVE, 2.0, 5), abs=1e-3)


def test_the_farthest_views_have_markers_in_cells_that_do_not_touch() -> None:
    model = ShapeModel.learn(RECTANGLE, CAMERA)
    """The window leaves room for those that are turned away."""
    apart = FINEST_SPACING_CELLS * finest_cell(640, 480)
    assert 0.7 * apart < model.side.shortest < apart


def test_a_camera_too_coarse_for_the_dock_is_no_error() -> None:
    model = ShapeModel.learn(RECTANGLE, CameraModel.nominal(64, 64))
    assert np.isfinite(model.covariance).all()


@pytest.mark.filterwarnings("error")
def test_a_dock_of_which_hardly_a_view_is_whole_has_a_shape_all_the_same() -> None:
    """Two markers a few millimetres apart are told from each other at arm's length alone."""
    points = DockGeometry.default().points.copy()
    points[0, 1] = points[2, 1] + 0.006
    model = ShapeModel.learn(points, CAMERA)
    assert np.isfinite(model.mean).all()
    for covariance in model.covariance:
        assert np.linalg.eigvalsh(covariance)[0] > 0
