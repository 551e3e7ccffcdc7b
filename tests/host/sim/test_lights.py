"""Lamps in an image: energy, place, halo, colour, and their image in the surface."""

import math
import statistics

import cv2
import jerlov
import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.sim.camera_spec import load_camera
from chromadock.sim.halo import MAX_ANGLE_RAD, HaloTable
from chromadock.sim.lights import Emitter, Lamps, LampSpec
from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.sim.water import Water
from chromadock.sim.waves import GaussianField

SPEC = LampSpec(
    red=Emitter(622.0, 20.0, 0.4),
    green=Emitter(523.0, 35.0, 0.7),
    blue=Emitter(466.0, 25.0, 0.19),
    diameter_m=0.01,
    half_angle_deg=60.0,
)
PINHOLE = CameraModel(640, 480, np.array([[512.0, 0, 319.5], [0, 500.0, 239.5], [0, 0, 1]]))
VEHICLE = load_camera("vehicle")
BACK = np.array([0.0, 0.0, -1.0])
"""Along this axis a lamp ahead shines straight back at the camera."""
LEVEL = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
"""R_world_camera of a level camera that looks north."""
WATERS = {
    "pool": Water.pool(),
    "1C": Water.jerlov_type("1C"),
    "9C": Water.jerlov_type("9C"),
    "lake": Water.lake(2.0),
}


class Calm:
    """A surface without a wave."""

    def slope(self, time_s, x_m, y_m):
        return np.zeros((*np.broadcast(x_m, y_m).shape, 2))


def unscattering(water):
    """The same beam attenuation without any scattering, so without a halo."""
    return Water("unscattering", water.c, np.zeros_like(water.b), water.phase)


def lamps(water, camera=PINHOLE, spec=SPEC, response=VEHICLE.sensor.response):
    return Lamps(spec, camera, response, water, HaloTable(water.phase))


def image(drawn, points, axis=BACK, share=(1, 1, 1), visible=1.0, camera=PINHOLE):
    points = np.atleast_2d(np.asarray(points, float))
    light = np.zeros((camera.height, camera.width, 3), np.float32)
    drawn.draw(light, points, np.tile(axis, (len(points), 1)), share, np.full(len(points), visible))
    return light.astype(np.float64)


def directions(camera):
    """(H, W, 3) unit rays, by the pinhole's own formula."""
    u, v = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    k = camera.matrix
    rays = np.stack([(u - k[0, 2]) / k[0, 0], (v - k[1, 2]) / k[1, 1], np.ones(u.shape)], -1)
    return rays / np.linalg.norm(rays, axis=-1, keepdims=True)


def solid_angle(camera):
    """(H, W) sr: cos^3 / (fx fy)."""
    return directions(camera)[..., 2] ** 3 / (camera.matrix[0, 0] * camera.matrix[1, 1])


def energy(light, camera=PINHOLE):
    return np.einsum("ijc,ij->c", light, solid_angle(camera))


def centroid(light):
    flux = light.sum(axis=-1)
    v, u = np.indices(flux.shape)
    return np.array([(u * flux).sum(), (v * flux).sum()]) / flux.sum()


def expected_signal(water, distance, led, response):
    """Beer-Lambert times inverse square, on a fine wavelength grid and from CIE's own tables."""
    fine = np.arange(400.0, 700.5, 0.5)
    bell = np.exp(-4 * math.log(2) * ((fine - led.peak_nm) / led.fwhm_nm) ** 2)
    cmf_nm, cmf = jerlov.cie_1931_cmf()
    luminosity = np.interp(fine, cmf_nm, cmf[:, 1])
    intensity = bell * led.intensity_cd / (683 * 0.5 * (bell * luminosity).sum())
    d65 = np.interp(fine, *jerlov.d65())
    white = d65 / (683 * 0.5 * (d65 * luminosity).sum())
    c = np.interp(fine, WAVELENGTHS_NM, water.c)
    arriving = intensity * np.exp(-c * distance) / distance**2
    curves = np.stack([np.interp(fine, WAVELENGTHS_NM, curve) for curve in response.curves])
    return (curves @ arriving) / (curves @ white)


@pytest.mark.parametrize("name", WATERS)
@pytest.mark.parametrize("distance", [0.5, 1.0, 3.0, 6.0])
def test_the_energy_of_a_lone_lamp_is_beer_lambert_times_inverse_square(
    name, distance, record_property
):
    water = unscattering(WATERS[name])
    drawn = lamps(water)
    worst = 0.0
    for index, led in enumerate((SPEC.red, SPEC.green, SPEC.blue)):
        share = np.eye(3)[index]
        found = energy(image(drawn, [0.04, -0.06, math.sqrt(distance**2 - 0.0052)], share=share))
        # The lamp's axis is the camera's, so that the lamp is a little off its own axis.
        found *= distance / math.sqrt(distance**2 - 0.0052)
        wanted = expected_signal(water, distance, led, VEHICLE.sensor.response)
        strongest = wanted.argmax()
        worst = max(worst, abs(found[strongest] / wanted[strongest] - 1))
        assert found == pytest.approx(wanted, rel=0.01, abs=0.002 * wanted.max())
        assert drawn.signal(distance, share) == pytest.approx(
            wanted, rel=0.01, abs=0.002 * wanted.max()
        )
    record_property("figure", f"lamp in {name}, {distance:g} m: energy off by {worst:.2%}")


def test_the_unscattered_part_is_the_same_with_scattering():
    water = WATERS["lake"]
    distances = np.array([0.5, 2.0, 5.0])
    for share in np.eye(3):
        assert lamps(water).signal(distances, share) == pytest.approx(
            lamps(unscattering(water)).signal(distances, share)
        )


@pytest.mark.parametrize("camera", [PINHOLE, VEHICLE.model], ids=["pinhole", "vehicle"])
def test_the_flux_centroid_is_the_projected_point(camera, record_property):
    rng = np.random.default_rng(3)
    # Without a halo, which the image's edge would cut off unevenly.
    drawn = lamps(unscattering(WATERS["pool"]), camera)
    errors = []
    for _ in range(25):
        z = rng.uniform(0.4, 6)
        point = np.array([rng.uniform(-0.45, 0.45) * z, rng.uniform(-0.35, 0.35) * z, z])
        true = camera.project(point)[0]
        errors.append(np.linalg.norm(centroid(image(drawn, point, camera=camera)) - true))
    record_property("figure", f"centroid off by at most {max(errors):.4f} px")
    assert max(errors) < 0.02


def petzold_share_within(station, angle_rad):
    """Share of b within an angle, integrated here from the report's own numbers."""
    petzold = jerlov.petzold_scattering(station)
    theta = np.radians(petzold.angles_deg)
    dense = np.geomspace(theta[0], math.pi, 20000)
    vsf = np.exp(np.interp(np.log(dense), np.log(theta), np.log(petzold.vsf)))
    ring = 2 * math.pi * np.sin(dense) * vsf
    steps = np.concatenate([[0], np.cumsum((ring[1:] + ring[:-1]) / 2 * np.diff(dense))])
    within = petzold.fraction_below_0_1_deg + steps / petzold.b
    # Below 0.1 degree the report's power law; it holds very little of a degree's light.
    return np.interp(angle_rad, np.append(0, dense), np.append(0, within))


@pytest.mark.parametrize("degrees", [1, 3, 10])
def test_a_thin_halo_holds_the_phase_functions_share_of_small_angles(degrees, record_property):
    # Light scattered by theta at the share u of the way arrives at the angle u theta.
    station, tau, distance = "HAOCE 11", 0.02, 2.0
    base = WATERS["pool"]
    water = Water("thin", base.a, np.full_like(base.a, tau / distance), base.phase)
    assert water.phase.station == station
    light = image(lamps(water), [0, 0, distance], share=(0, 1, 0))
    angle = np.arccos(np.clip(directions(PINHOLE)[..., 2], -1, 1))
    within = (light[..., 1] * solid_angle(PINHOLE))[angle < math.radians(degrees)].sum()
    direct = lamps(water).signal(distance, (0, 1, 0))[1]
    u = (np.arange(2000) + 0.5) / 2000
    largest = np.minimum(math.radians(degrees) / u, MAX_ANGLE_RAD)
    single = petzold_share_within(station, largest).mean()
    found = (within / direct - 1) / tau
    record_property(
        "figure", f"halo within {degrees} deg: {found:.3f} of b r, Petzold {single:.3f}"
    )
    assert found == pytest.approx(single, rel=0.02)


@pytest.mark.parametrize("name", ["pool", "lake", "9C"])
@pytest.mark.parametrize("degrees", [1, 3, 10])
def test_a_halo_in_the_image_holds_what_the_table_says(name, degrees, record_property):
    water, distance = WATERS[name], 2.0
    narrow = LampSpec(
        red=SPEC.red,
        green=Emitter(525.0, 5.0, 1.0),
        blue=SPEC.blue,
        diameter_m=0.01,
        half_angle_deg=60,
    )
    drawn = lamps(water, spec=narrow)
    at = int(np.argmin(abs(WAVELENGTHS_NM - 525)))
    tau = water.b[at] * distance
    light = image(drawn, [0, 0, distance], share=(0, 1, 0))
    angle = np.arccos(np.clip(directions(PINHOLE)[..., 2], -1, 1))
    within = (light[..., 1] * solid_angle(PINHOLE))[angle < math.radians(degrees)].sum()
    direct = drawn.signal(distance, (0, 1, 0))[1]
    table = HaloTable(water.phase)
    outer, rings = table.edges_rad[1:], math.pi * np.diff(table.edges_rad**2)
    cumulative = np.cumsum(table.density(tau) * rings)
    wanted = 1 + table.share(tau) * np.interp(math.radians(degrees), outer, cumulative)
    record_property(
        "figure", f"{name}, {degrees} deg: {within / direct:.3f} direct, table {wanted:.3f}"
    )
    assert within / direct == pytest.approx(wanted, rel=0.03)


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.37, 0.11), (0.5, 0.5)])
def test_where_a_lamp_lies_between_pixels_does_not_change_its_energy(place):
    drawn, distance = lamps(WATERS["1C"]), 4.0
    k = PINHOLE.matrix
    point = [(300 + place[0] - k[0, 2]) / k[0, 0], (240 + place[1] - k[1, 2]) / k[1, 1], 1]
    point = np.array(point) / np.linalg.norm(point) * distance
    light = image(drawn, point)[215:266, 275:326]
    centre = np.array([300 - k[0, 2], 240 - k[1, 2]]) / [k[0, 0], k[1, 1]]
    straight = image(drawn, np.array([*centre, 1]) / np.linalg.norm([*centre, 1]) * distance)
    assert light.sum() == pytest.approx(straight[215:266, 275:326].sum(), rel=0.005)


@pytest.mark.parametrize("camera", ["vehicle", "ov2640"])
@pytest.mark.parametrize(("led", "name"), list(enumerate(["red", "green", "blue"])))
def test_each_led_lights_its_own_channel_most(camera, led, name, record_property):
    spec = load_camera(camera)
    drawn = lamps(WATERS["pool"], spec.model, response=spec.sensor.response)
    light = image(drawn, [0, 0, 2.0], share=np.eye(3)[led], camera=spec.model)
    signal = light.sum(axis=(0, 1))
    figures = "/".join(f"{value:.2f}" for value in signal / signal.max())
    record_property("figure", f"{camera}: the {name} LED as R/G/B {figures}")
    assert signal.argmax() == led


@pytest.mark.parametrize("half_angle", [20.0, 45.0, 60.0])
def test_intensity_falls_off_from_the_axis_as_a_power_of_the_cosine(half_angle):
    spec = LampSpec(SPEC.red, SPEC.green, SPEC.blue, SPEC.diameter_m, half_angle)
    drawn = lamps(WATERS["pool"], spec=spec)

    def total(degrees):
        angle = math.radians(degrees)
        return image(drawn, [0, 0, 2], [math.sin(angle), 0, -math.cos(angle)]).sum()

    assert total(half_angle) == pytest.approx(total(0) / 2, rel=1e-5)
    power = math.log(0.5) / math.log(math.cos(math.radians(half_angle)))
    assert total(15) == pytest.approx(total(0) * math.cos(math.radians(15)) ** power, rel=1e-5)
    assert total(100) == 0


def test_what_is_hidden_does_not_shine_and_lamps_add_up():
    drawn = lamps(WATERS["1C"])
    points = np.array([[-0.4, 0.1, 3], [0.4, 0.0, 3.5]])
    both = image(drawn, points)
    apart = image(drawn, points[0]) + image(drawn, points[1])
    # Single precision of angles: a neighbouring row of the halo's table now and then.
    np.testing.assert_allclose(both, apart, rtol=0.01)
    np.testing.assert_allclose(image(drawn, points, visible=0.5), both / 2, rtol=0.01)
    assert not image(drawn, points, visible=0.0).any()
    assert not image(drawn, points, share=(0, 0, 0)).any()


def test_lamps_are_added_to_what_is_there():
    drawn = lamps(WATERS["1C"])
    light = np.full((480, 640, 3), 100, np.float32)
    drawn.draw(light, [[0.1, 0, 2]], [BACK], (1, 0, 0), [1.0])
    alone = image(drawn, [0.1, 0, 2], share=(1, 0, 0))
    np.testing.assert_allclose(light - 100, alone, atol=0.01)


def test_a_lamp_outside_the_image_sends_only_its_halo_in():
    drawn, clear = lamps(WATERS["lake"]), lamps(unscattering(WATERS["lake"]))
    outside = [0.70, 0.0, 1.0]
    assert not image(clear, outside).any()
    light = image(drawn, outside)
    assert light[:, -40:].sum() > 10 * light[:, :40].sum() > 0
    assert not image(drawn, [0.1, 0.0, -1.0], axis=-BACK).any()


def test_a_near_lamp_is_a_disc_of_its_size():
    spec = LampSpec(SPEC.red, SPEC.green, SPEC.blue, diameter_m=0.03, half_angle_deg=60)
    light = image(lamps(unscattering(WATERS["pool"]), spec=spec), [0, 0, 0.5])[..., 1]
    area = (light > light.max() / 2).sum()
    assert math.sqrt(area * 4 / math.pi) == pytest.approx(0.03 / 0.5 * 506, rel=0.06)
    assert light[light > light.max() / 2].std() < 0.15 * light.max()


def fresnel(degrees):
    """Out of water of n = 1.34, by the angles' sines and tangents, not by cosines."""
    i = math.radians(degrees)
    if 1.34 * math.sin(i) >= 1:
        return 1.0
    t = math.asin(1.34 * math.sin(i))
    s = math.sin(i - t) ** 2 / math.sin(i + t) ** 2
    p = math.tan(i - t) ** 2 / math.tan(i + t) ** 2
    return (s + p) / 2


def pitched(degrees):
    """R_world_camera of a camera that looks north and up."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return LEVEL @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def mirrored(drawn, lamp_world, axis_world, rotation, depth, waves, moment=0.0):
    light = np.zeros((480, 640, 3), np.float32)
    drawn.draw_mirrored(
        light,
        np.atleast_2d(lamp_world) @ rotation,
        np.atleast_2d(axis_world) @ rotation,
        (1, 1, 1),
        np.ones(len(np.atleast_2d(lamp_world))),
        waves=waves,
        time_s=moment,
        R_world_camera=rotation,
        depth_m=depth,
    )
    return light.astype(np.float64)


@pytest.mark.parametrize(
    ("distance", "incidence"), [(3.0, 56.3), (4.0, 63.4), (2.0, 45.0), (1.5, 36.9), (0.9, 24.4)]
)
def test_the_mirror_image_stands_above_the_surface_with_fresnels_share(
    distance, incidence, record_property
):
    depth, water = 1.2, unscattering(WATERS["pool"])
    lamp = np.array([distance, 0.1, -0.4])  # 0.8 m deep, so that its image is 2 m above
    assert math.degrees(math.atan2(math.hypot(distance, 0.1), 2.0)) == pytest.approx(
        incidence, abs=0.1
    )
    rotation = pitched(90 - incidence)
    image_place = np.array([distance, 0.1, -depth - 0.8])
    length = np.linalg.norm(image_place)
    # The lamp shines straight at the place of the surface that shows it.
    axis = -image_place / length * [1, 1, -1]
    drawn = lamps(water)
    light = mirrored(drawn, lamp, axis, rotation, depth, Calm())
    wanted = PINHOLE.project(rotation.T @ image_place)[0]
    assert centroid(light) == pytest.approx(wanted, abs=0.02)
    share = energy(light)[1] / drawn.signal(length, (1, 1, 1))[1]
    record_property("figure", f"incidence {incidence:g} deg: reflects {share:.4f}")
    assert share == pytest.approx(fresnel(incidence), rel=0.01)


def test_waves_break_the_mirror_image_into_glints_about_it():
    depth, drawn = 1.0, lamps(unscattering(WATERS["pool"]))
    lamp, rotation = np.array([3.5, 0.0, 0.0]), pitched(25)
    calm = mirrored(drawn, lamp, [-1, 0, 0], rotation, depth, Calm())
    places, peaks, totals = [], [], []
    for moment in range(30):
        light = mirrored(drawn, lamp, [-1, 0, 0], rotation, depth, GaussianField(4, 2.0), moment)
        flux = light.sum(axis=-1)
        spread = cv2.dilate(flux, np.ones((7, 7)))
        peaks.append(int(((flux == spread) & (flux > flux.max() / 30)).sum()))
        places.append(centroid(light))
        totals.append(flux.sum() / calm.sum())
    assert 3 <= statistics.median(peaks) <= 9
    assert np.mean(places, axis=0) == pytest.approx(centroid(calm), abs=15)
    assert np.std(places, axis=0).max() > 3
    assert 0.6 < np.mean(totals) < 1.1


def test_a_lamp_that_is_lifted_out_of_the_water_has_no_mirror_image():
    drawn = lamps(WATERS["pool"])
    waves = GaussianField(4)
    assert not mirrored(drawn, [3.0, 0, -1.2], [-1.0, 0, 0], pitched(20), 1.0, waves).any()


def test_the_same_moment_gives_the_same_image():
    waves = GaussianField(4, 3.0)
    first, second = (
        mirrored(lamps(WATERS["1C"]), [3.0, 0.2, 0], [-1.0, 0, 0], pitched(20), 1.0, waves, 2.5)
        for _ in range(2)
    )
    assert first.any()
    assert (first == second).all()
