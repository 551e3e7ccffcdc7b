"""Solid things: outlines, daylight, what the water takes of them, what they hide."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.sim.ambient import Ambient
from chromadock.sim.bodies import Bodies
from chromadock.sim.body import Body
from chromadock.sim.camera_spec import load_camera
from chromadock.sim.flat_shapes import Box, Panel
from chromadock.sim.pixel_finder import PixelFinder
from chromadock.sim.rays import solid_angles
from chromadock.sim.response import Response
from chromadock.sim.round_shapes import Sphere, Tube
from chromadock.sim.shapes import Shape
from chromadock.sim.shutter import Shutter
from chromadock.sim.spectrum import WAVELENGTHS_NM, reflectance
from chromadock.sim.transform import Transform, turned
from chromadock.sim.water import Water

WIDTH, HEIGHT = 160, 120
CAMERA = CameraModel(
    WIDTH,
    HEIGHT,
    np.array([[128.0, 0, 79.5], [0, 128.0, 59.5], [0, 0, 1]]),
    np.array([-0.08, 0.03, 0.0, 0.0, 0.0]),
)
# Each channel sees one wavelength, so that Beer-Lambert's law holds for it by itself.
LINES_NM = {"red": 620.0, "green": 530.0, "blue": 470.0}
NARROW = Response.of_bands(*([(peak, 5.0, 1.0)] for peak in LINES_NM.values()))
WATER = Water.jerlov_type("3C")
EYE = turned(0, 0, 0)
LEVEL = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # looks north; world: north, east, down
WHITE = np.ones(61)
PIXELS = np.stack(np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)), axis=-1).reshape(-1, 2)
AREAS = solid_angles(CAMERA, PIXELS).reshape(HEIGHT, WIDTH)


@dataclass
class View:
    """A camera at a depth that looks north; the dock's frame is the camera's, or moves in it."""

    depth_m: float = 3.0
    speed_m_s: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def T_world_camera(self, time_s: float) -> Transform:
        return Transform(LEVEL, np.array([0, 0, self.depth_m]))

    def T_world_dock(self, time_s: float) -> Transform:
        return self.T_world_camera(time_s) @ Transform(np.eye(3), self.speed_m_s * time_s)


def ambient(**changes: object) -> Ambient:
    usual = {
        "water": WATER,
        "surface_illuminance_lux": 50000.0,
        "sun_elevation_deg": 50.0,
        "sun_azimuth_deg": 180.0,
        "diffuse_share": 0.3,
        "flicker": False,
    }
    return Ambient(**{**usual, **changes})


def bodies(
    *shapes: Shape | Body, view: View | None = None, light: Ambient | None = None, **rest: float
) -> Bodies:
    made = [one if isinstance(one, Body) else Body(one, WHITE, "dock") for one in shapes]
    shutter = Shutter(HEIGHT, rest.get("readout_s", 0.0))
    return Bodies(made, CAMERA, NARROW, shutter, light or ambient(), view or View())


def drawn(of: Bodies, behind: float = 0.0, time_s: float = 0.0) -> np.ndarray:
    image = np.full((HEIGHT, WIDTH, 3), behind, np.float32)
    of.draw(image, time_s)
    return image


def coverage(shape: Shape) -> np.ndarray:
    """(H, W) shares of pixels, with edges about a pixel wide."""
    finder = PixelFinder(CAMERA)
    image = np.zeros(HEIGHT * WIDTH)
    pixels, rays = finder.find(shape, range(HEIGHT), finder.pixel_rad)
    image[pixels] = shape.coverage(rays, finder.pixel_rad)
    return image.reshape(HEIGHT, WIDTH)


def at(nm: float, values: np.ndarray) -> float:
    return float(np.interp(nm, WAVELENGTHS_NM, values))


@pytest.mark.parametrize("place", [(0.0, 0.0, 2.0), (0.4, -0.3, 1.2), (-0.7, 0.5, 2.0)])
def test_a_ball_fills_its_solid_angle(place: tuple[float, float, float], record_property) -> None:
    centre, radius = np.array(place), 0.15
    wanted = 2 * np.pi * (1 - np.sqrt(1 - (radius / np.linalg.norm(centre)) ** 2))
    found = (coverage(Sphere(centre, radius)) * AREAS).sum()
    record_property("figure", f"solid angle of a ball over 2 pi (1 - cos): {found / wanted:.4f}")
    assert found == pytest.approx(wanted, rel=0.01)


@pytest.mark.parametrize("radius_px", [0.1, 0.5, 5.0])
def test_a_tube_fills_its_width_however_thin(radius_px: float) -> None:
    radius = radius_px / 128 * 2
    image = coverage(Tube(np.array([-5.0, 0, 2]), np.array([5.0, 0, 2]), radius))
    assert image[:, WIDTH // 2].sum() == pytest.approx(2 * radius_px, rel=0.02)


def test_a_panel_is_the_polygon_of_its_projected_corners() -> None:
    centre, across, down = (
        np.array([0.2, 0.1, 1.5]),
        np.array([0.4, 0.1, 0.3]),
        np.array([0, 0.3, 0.1]),
    )
    corners = [centre + i * across + j * down for i, j in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
    # Along the edges too: the lens bends them.
    outline = np.concatenate(
        [
            np.linspace(a, b, 20, endpoint=False)
            for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
        ]
    )
    polygon = cv2.contourArea(CAMERA.project(outline).astype(np.float32))
    assert coverage(Panel(centre, across, down)).sum() == pytest.approx(polygon, rel=0.01)


def test_a_box_is_met_where_a_ray_crosses_all_three_slabs() -> None:
    centre, half = np.array([0.3, -0.2, 1.4]), np.array([0.3, 0.15, 0.2])
    box = Box(np.zeros(3), np.eye(3), half).moved(Transform(turned(30, 20, 10), centre))
    finder = PixelFinder(CAMERA)
    pixels, rays = finder.find(box, range(HEIGHT), finder.pixel_rad)
    hits = box.hits(rays, finder.pixel_rad)
    R = turned(30, 20, 10)
    missed = np.setdiff1d(np.arange(len(pixels)), hits.index)
    coverage = np.concatenate([hits.coverage, np.zeros(len(missed))])
    order = np.concatenate([hits.index, missed])
    for k, (pixel, ray, covered) in enumerate(
        zip(pixels[order], rays.T[order].astype(float), coverage, strict=True)
    ):
        bounds = [sorted(((-h - o) / d, (h - o) / d)) for h, o, d in
                  zip(half, R.T @ -centre, R.T @ ray, strict=True)]  # fmt: skip
        enters, leaves = max(low for low, _ in bounds), min(high for _, high in bounds)
        if covered in (0.0, 1.0):
            assert (enters < leaves) == bool(covered), PIXELS[pixel]
        if covered == 1:
            assert hits.range_m[k] == pytest.approx(enters, rel=1e-4)
            local = R.T @ (enters * ray - centre)
            face = np.argmax(np.abs(local) / half)
            np.testing.assert_allclose(
                hits.normal[:, k], np.sign(local[face]) * R[:, face], atol=1e-5
            )
    assert (hits.coverage == 1).sum() > 500


def test_balls_and_tubes_are_met_on_their_surface() -> None:
    finder = PixelFinder(CAMERA)
    ball = Sphere(np.array([0.1, 0.2, 1.0]), 0.2)
    tube = Tube(np.array([-0.5, -0.3, 1.5]), np.array([0.6, 0.2, 1.0]), 0.1)
    for shape in (ball, tube):
        _, rays = finder.find(shape, range(HEIGHT), finder.pixel_rad)
        hits = shape.hits(rays, finder.pixel_rad)
        whole = hits.coverage == 1
        points = (rays[:, hits.index[whole]] * hits.range_m[whole]).T
        inwards = points - 0.05 * hits.normal[:, whole].T
        if shape is ball:
            distance = [np.linalg.norm(p - ball.centre, axis=1) for p in (points, inwards)]
            wanted = ball.radius_m
        else:
            axis = tube.end - tube.start
            spread = [
                np.cross(p - tube.start, axis / np.linalg.norm(axis)) for p in (points, inwards)
            ]
            assert hits.along is not None
            beside = (hits.along[whole] > 0.02) & (hits.along[whole] < 0.98)
            distance = [np.linalg.norm(v, axis=1)[beside] for v in spread]
            wanted = tube.radius_m
        np.testing.assert_allclose(distance[0], wanted, rtol=0.02)
        np.testing.assert_allclose(distance[1], wanted - 0.05, rtol=0.05)


@pytest.mark.parametrize("range_m", [1.0, 3.0, 6.0])
def test_the_contrast_of_a_black_target_falls_by_beer_lambert(
    range_m: float, record_property
) -> None:
    size = 0.3 * range_m
    black = Panel(np.array([0, 0, range_m]), np.array([size, 0, 0]), np.array([0, size, 0]))
    image = drawn(bodies(Body(black, np.zeros(61), "dock")), behind=100.0)
    contrast = 1 - image[HEIGHT // 2, WIDTH // 2] / 100
    wanted = np.exp([-at(nm, WATER.c) * range_m for nm in LINES_NM.values()])
    record_property("figure", f"contrast of black at {range_m:g} m: {contrast}, exp(-cr) {wanted}")
    np.testing.assert_allclose(contrast, wanted, rtol=0.01, atol=2e-4)


def test_at_the_visibility_of_a_lake_a_black_target_has_gone() -> None:
    lake = ambient(water=Water.lake(2.0))
    black = Body(Sphere(np.array([0, 0, 2.2]), 0.2), np.zeros(61), "dock")
    contrast = 1 - drawn(bodies(black, light=lake), behind=100.0)[60, 80] / 100
    # Zaneveld & Pegau (2003): c(532) times the visibility is 4.8.
    assert contrast[1] == pytest.approx(np.exp(-4.8), rel=0.05)


def test_a_level_face_returns_the_daylight_that_falls_on_it() -> None:
    """Lambert's law by hand: rho E / pi, dimmed on the way to the camera."""
    light = ambient()
    ahead = Panel(np.array([0, 0.35, 1.5]), np.array([0.3, 0, 0]), np.array([0, 0, 0.3]))
    ball = drawn(bodies(Body(ahead, 0.5 * WHITE, "dock"), light=light))
    row, column = CAMERA.project([[0, 0.35, 1.5]])[0].round().astype(int)[::-1]
    depth, range_m = 3.35, np.hypot(0.35, 1.5)
    sky = light.diffuse_share_at(0.0)
    falls = light.downwelling(depth, 0.0) * ((1 - sky) + sky)
    wanted = NARROW.signal(0.5 / np.pi * falls * np.exp(-WATER.c * range_m))
    np.testing.assert_allclose(ball[row, column], wanted, rtol=0.02)


def test_faces_away_from_the_sun_get_the_light_from_around_only() -> None:
    light = ambient(diffuse_share=0.0)
    north = Panel(np.array([0, 0, 1.0]), np.array([0.3, 0, 0]), np.array([0, 0.3, 0]))
    facing_south = drawn(bodies(north, light=light))[60, 80]
    behind = ambient(diffuse_share=0.0, sun_azimuth_deg=0.0)
    shaded = drawn(bodies(north, light=behind))[60, 80]
    sun = light.sun_direction
    down = light.downwelling(3.0, 0.0)
    lit = sun[0] / sun[2] + 0.5 * 0.33 * WATER.bb / WATER.a
    left = np.exp(-WATER.c)
    np.testing.assert_allclose(facing_south, NARROW.signal(down / np.pi * lit * left), rtol=0.01)
    from_below = 0.5 * 0.33 * WATER.bb / WATER.a
    np.testing.assert_allclose(shaded, NARROW.signal(down / np.pi * from_below * left), rtol=0.01)


@pytest.mark.parametrize("channel", [0, 1, 2])
def test_paint_of_a_colour_shines_in_its_own_channel(channel: int) -> None:
    response = load_camera("vehicle").sensor.response
    near = Sphere(np.array([0, 0, 0.6]), 0.1)
    of = Bodies(
        [Body(near, reflectance(np.eye(3)[channel]), "dock")],
        CAMERA,
        response,
        Shutter(HEIGHT, 0.0),
        ambient(),
        View(0.3),
    )
    assert drawn(of)[55, 80].argmax() == channel


def test_what_is_nearer_covers_what_is_farther() -> None:
    near, far = (Body(Sphere(np.array([0, 0, z]), 0.1 * z), c * WHITE, "dock")
                 for z, c in ((1.0, 0.2), (2.0, 0.9)))  # fmt: skip
    alone = drawn(bodies(near))
    np.testing.assert_array_equal(drawn(bodies(near, far))[60, 80], alone[60, 80])
    np.testing.assert_array_equal(drawn(bodies(far, near))[60, 80], alone[60, 80])


def test_nothing_behind_or_around_the_camera_is_drawn() -> None:
    shapes = (
        Sphere(np.array([0, 0, -1.0]), 0.5),
        Sphere(np.zeros(3), 0.5),
        Tube(np.array([0.2, 0, -3.0]), np.array([0.2, 0, -0.1]), 0.05),
        Box(np.zeros(3), np.eye(3), np.full(3, 0.4)),
        Panel(np.array([0, 0, -1.0]), np.array([1.0, 0, 0]), np.array([0, 1.0, 0])),
        Panel(np.array([0, 0, 1.0]), np.array([0, 0, 0.5]), np.array([0, 0.5, 0])),  # edge on
    )
    assert (drawn(bodies(*shapes), behind=7.0) == 7).all()


def test_a_tube_that_passes_the_camera_is_seen_where_it_is_ahead() -> None:
    tube = Tube(np.array([0.3, 0, -2.0]), np.array([0.3, 0, 4.0]), 0.05)
    image = drawn(bodies(tube), behind=0.0)[..., 1]
    assert image[60, 120] > 0  # (0.3, 0, z) is at x / z right of the middle
    assert not image[:, :80].any()


def test_things_fixed_to_the_dock_move_with_it_and_others_do_not() -> None:
    view = View(speed_m_s=np.array([0.5, 0.0, 0.0]))
    ball = Sphere(np.array([0, 0, 2.0]), 0.1)
    outside = Body(
        Sphere(np.array([2.0, 0, 3.0]), 0.1), WHITE, "world"
    )  # 2 m north, camera's depth

    def middle(of: Bodies, time_s: float) -> float:
        image = drawn(of, time_s=time_s)[..., 1]
        return float((image.sum(axis=0) * np.arange(WIDTH)).sum() / image.sum())

    assert middle(bodies(ball, view=view), 1.0) - 79.5 == pytest.approx(128 * 0.25, rel=0.03)
    assert middle(bodies(outside, view=view), 1.0) == pytest.approx(79.5, abs=0.1)


def test_a_body_that_is_present_for_a_while_is_seen_and_hides_only_then() -> None:
    passing = Body(Sphere(np.array([0, 0, 2.0]), 0.1), WHITE, "dock", (1.0, 1.5))
    seen = bodies(passing)
    behind = np.array([[0.0, 0.0, 3.0]])
    for time_s, there in ((0.99, False), (1.0, True), (1.49, True), (1.5, False)):
        assert (drawn(seen, time_s=time_s).max() > 0) == there
        assert seen.visible(behind, 0.01, time_s)[0] == pytest.approx(0.0 if there else 1.0)


def test_a_rolling_shutter_slants_a_post_that_moves() -> None:
    view = View(speed_m_s=np.array([2.0, 0.0, 0.0]))
    post = Tube(np.array([0, -3.0, 2.0]), np.array([0, 3.0, 2.0]), 0.05)
    image = drawn(bodies(post, view=view, readout_s=0.1))[..., 1]
    columns = (image * np.arange(WIDTH)).sum(axis=1) / image.sum(axis=1)
    # 2 m/s at 2 m: 128 px/s, over 0.1 s from the first row to the last, in eight bands.
    assert columns[-8] - columns[7] == pytest.approx(12.8, abs=2.0)
    assert columns[HEIGHT // 2] == pytest.approx(79.5, abs=1.0)


def test_half_a_disc_behind_an_edge_is_half_visible() -> None:
    wall = Panel(np.array([0.5, 0, 1.0]), np.array([0.5, 0, 0]), np.array([0, 0.5, 0]))
    of = bodies(wall)
    points = np.array([[0.0, 0, 2.0], [0.3, 0, 2.0], [-0.3, 0, 2.0], [0.3, 0, 0.5]])
    np.testing.assert_allclose(of.visible(points, 0.05, 0.0), [0.5, 0, 1, 1], atol=0.02)


def test_waves_make_bodies_flicker_about_their_mean() -> None:
    steady, flickering = (bodies(Sphere(np.array([0, 0, 1.0]), 0.2), view=View(1.0),
                                 light=ambient(flicker=on)) for on in (False, True))  # fmt: skip
    mean = drawn(steady)[60, 80, 1]
    seen = np.array([drawn(flickering, time_s=t)[60, 80, 1] for t in np.arange(0, 60, 0.25)])
    assert seen.mean() == pytest.approx(mean, rel=0.15)
    wanted = np.sqrt(np.expm1(ambient(flicker=True).flicker_sigma(1.0, 0.0) ** 2))
    assert seen.std() / mean == pytest.approx(at(530, wanted), rel=0.25)
