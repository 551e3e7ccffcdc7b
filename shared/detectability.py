"""How far a marker of each hue is seen, in simulated waters of every colour.

The waters, the daylight in them, the LEDs and both cameras are those of ``chromadock.sim``.  A
view is what a camera sees of endless water in one direction.  The marker is one lamp before a
dark holder, seen along a level path: its light arrives by Beer-Lambert and the inverse square, and
the holder takes the water's own light away from behind it.  The vehicle looks at it as its robust
method does: by a matched filter for the pure hue, in cells as wide as a far marker's image.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock import method
from chromadock.colour.hsv import hsv_from_rgb, rgb_from_hsv
from chromadock.errors import ChromadockError
from chromadock.sim.camera_spec import CameraSpec, load_camera
from chromadock.sim.control import CameraSettings
from chromadock.sim.radiance import SunAndSky, path_radiance
from chromadock.sim.scattered_daylight import ScatteredDaylight
from chromadock.sim.scene import load_scene
from chromadock.sim.sensor import tone_curve
from chromadock.sim.spectrum import led_intensity
from chromadock.sim.water import JERLOV_TYPES, Water

Floats = NDArray[np.float64]

POOLS_PER_M = (0.05, 0.1, 0.2, 0.4, 0.8)
"""Scattering of pools, from just filled to unfit for bathing."""
LAKES_M = (0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0)
"""Visibility of lakes; each with ..."""
CDOM_PER_M = (0.0, 0.3, 1.0, 2.0, 4.0)
"""... so much dissolved matter: green lakes to bog water."""
MIXED = (("IB", "3C"), ("III", "5C"), ("II", "7C"))
"""Halves of two Jerlov types: where a river meets the sea."""
LIGHTS = ((80_000.0, 60.0, 0.2), (30_000.0, 30.0, 0.3), (8_000.0, 40.0, 1.0), (3_000.0, 10.0, 0.5))
"""Illuminance under the surface, lux, the sun's elevation, degrees, the sky's share: noon,
afternoon, overcast, evening."""
DEPTHS_M = (0.7, 1.5, 3.0, 6.0, 10.0)
SLOPES = (-0.15, 0.0, 0.3)
"""How much deeper a metre of the line of sight leads: a little up, level, down on a floor."""
AZIMUTHS_DEG = (0.0, 90.0, 180.0)
"""Of the line of sight from where the sun stands."""

RANGES_M: Floats = np.geomspace(0.5, 8.0, 65)
"""Evenly spaced in their logarithm: a tenth farther counts alike in any water."""

LED_GAMMA = 2.2
"""From colour to light: the docks' default."""
CELL_RAD = 4 / 512
"""The robust method's finest cells in the vehicle's camera."""
CELL_PIXELS = (4, 8, 4)
"""Of a Bayer mosaic in a cell of 4 x 4: red, green, blue."""
LIGHT_IN_CELL = 0.5
"""Of a lamp's light in the brightest cell, wherever among four it falls."""
HOLDER_M = 0.05
"""How wide the lamp's dark holder is: that of ``scenes/pool.toml``."""
FLUCTUATION = 0.05
"""Of the water's light from cell to cell, as a share of it and in its own colour: waves, shafts,
specks, the edges of the dock itself.  On the 43 photographs of the test data the median is 0.025,
and nine in ten have less than 0.095 (``tests/parity/test_contrast.py``)."""
QUANTUM = (2.2 * 0.05**1.2 / 255) ** 2 / 12
"""Variance of linear light that 8 bits leave in dark water, at a twentieth of white."""
LEAST_SNR = 10.0
"""Of a marker that is seen: all four must stand out, above what noise alone does anywhere."""
MOST_MISSING = 3.0
"""Standard deviations by which a channel may be darker than the water beside: a lamp adds light,
what takes some away is a painted thing."""


@dataclass(frozen=True, eq=False)
class Views:
    """Water of every colour.

    ``hue`` (n, 2): 0..1535, as the vehicle's and as the dock's camera see it.  ``range_m``
    (n, H): how far the vehicle sees a marker of each candidate hue, within ``RANGES_M``.
    """

    hue: NDArray[np.int32]
    range_m: Floats


def simulated_views(candidates: NDArray[np.int64]) -> Views:
    """All views whose hue means something to both cameras, for candidate hues (H,) 0..1535."""
    vehicle, dock = load_camera("vehicle"), load_camera("ov2640")
    drive = _led_shares(candidates)
    hues, ranges = [], []
    for water in _waters():
        lamp = _lamp_signal(water, vehicle, drive)
        for radiance in _radiances(water):
            seen = [
                _hue(vehicle, radiance, method.MIN_VALUE_VEHICLE),
                _hue(dock, radiance, method.MIN_VALUE),
            ]
            if None not in seen:
                hues.append(seen)
                ranges.append(_farthest_m(water, radiance, lamp, vehicle, drive))
    return Views(np.array(hues, np.int32), np.array(ranges))


def _waters() -> Iterator[Water]:
    yield from (Water.jerlov_type(name) for name in JERLOV_TYPES)
    yield from (Water.pool(scattering) for scattering in POOLS_PER_M)
    for visibility in LAKES_M:
        for cdom in CDOM_PER_M:
            try:
                yield Water.lake(visibility, cdom)
            except ChromadockError:  # more dissolved matter than such clear water can have
                continue
    for pair in MIXED:
        yield Water.mixed([(Water.jerlov_type(name), 0.5) for name in pair])


def _radiances(water: Water) -> Iterator[Floats]:
    """(61,) radiance of the water in each view."""
    slopes = np.array(SLOPES)
    for lux, elevation, sky_share in LIGHTS:
        light = ScatteredDaylight(water, lux, elevation, 0.0, sky_share)
        source = SunAndSky(water.phase, light.sun_direction)
        sky = source.sky(slopes)
        surface = light.veiling_radiance(0.0, 0.0)
        for depth in DEPTHS_M:
            length = np.where(slopes < 0, depth / np.maximum(-slopes, 1e-9), np.inf)
            level = surface * np.exp(-light.kd * depth)
            paths = path_radiance(level, water.c, light.kd, slopes, length)
            for azimuth in np.radians(AZIMUTHS_DEG):
                across = np.sqrt(1 - slopes**2)
                sight = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), slopes])
                sun = source.sun(sight.astype(np.float32))
                yield from paths * (sky_share * sky + (1 - sky_share) * sun)[:, None]


def _exposed(camera: CameraSpec, radiance: Floats) -> tuple[Floats, CameraSettings]:
    """(3,) linear white-balanced R, G, B of a camera that meters on this water, 1 is white."""
    signal = camera.sensor.response.signal(radiance)
    settings = camera.auto_control().settle(signal)
    return np.minimum(signal * camera.sensor.level(settings), 1.0), settings


def _hue(camera: CameraSpec, radiance: Floats, min_value: int) -> int | None:
    """Hue 0..1535 of the water in the camera's picture; None where it means nothing."""
    light, _ = _exposed(camera, radiance)
    corrected = np.clip(camera.sensor.colour_matrix @ light, 0, 1)
    rgb = tone_curve(camera.sensor.gamma)[np.rint(65535 * corrected).astype(int)]
    hue, saturation, value, _ = hsv_from_rgb(rgb)
    grey = saturation < method.MIN_SATURATION or value < min_value
    return None if grey else int(hue)


def _led_shares(hues: NDArray[np.int64]) -> Floats:
    """(H, 3) share of full power of the three LEDs, which is the pure colour in linear light."""
    return np.array([(np.array(rgb_from_hsv(int(h), 255, 255)) / 255) ** LED_GAMMA for h in hues])


def _lamp_signal(water: Water, camera: CameraSpec, drive: Floats) -> Floats:
    """(H, R, 3) signal, cd/m^2, by which a lamp brightens its cell, before the exposure."""
    lamp = load_scene("pool").lamp
    intensity = np.stack(
        [
            led_intensity(led.peak_nm, led.fwhm_nm, led.intensity_cd)
            for led in (lamp.red, lamp.green, lamp.blue)
        ]
    )
    ranges = RANGES_M[:, None]
    through = np.exp(-water.c * ranges) / ranges**2
    signal = camera.sensor.response.signal(intensity * through[:, None])
    return np.asarray(np.einsum("hl,rlc->hrc", drive, signal) * (LIGHT_IN_CELL / CELL_RAD**2))


def _farthest_m(
    water: Water, radiance: Floats, lamp: Floats, camera: CameraSpec, drive: Floats
) -> Floats:
    """(H,) the farthest range at which each hue is seen before this water."""
    sensor = camera.sensor
    light, settings = _exposed(camera, radiance)
    level, matrix = sensor.level(settings), sensor.colour_matrix
    noise = _covariance(camera, light, settings)
    # What the holder hides is the water beyond it: endless water less that up to the range.
    hidden = sensor.response.signal(radiance * np.exp(-water.c * RANGES_M[:, None]))
    covered = np.minimum(1, HOLDER_M / (CELL_RAD * RANGES_M))
    gained = level * (lamp - covered[:, None] * hidden) @ matrix.T
    weights = np.linalg.solve(noise, drive.T).T
    deviation = np.sqrt(np.einsum("hc,hc->h", weights, drive))
    snr = np.einsum("hc,hrc->hr", weights, gained) / deviation[:, None]
    shines = (gained >= -MOST_MISSING * np.sqrt(np.diag(noise))).all(axis=2)
    seen = (snr >= LEAST_SNR) & shines
    farthest = seen.shape[1] - 1 - seen[:, ::-1].argmax(axis=1)
    return np.asarray(np.where(seen.any(axis=1), RANGES_M[farthest], RANGES_M[0]))


def _covariance(camera: CameraSpec, light: Floats, settings: CameraSettings) -> Floats:
    """(3, 3) of a cell's linear R, G, B before water of ``light`` (3,).

    Shot and read noise of the mosaic's pixels, through white balance and colour matrix; the
    water's own fluctuation, all in its colour; the rounding to 8 bits.
    """
    sensor = camera.sensor
    balance = np.array(settings.white_balance)
    electron = settings.gain / sensor.full_well_e
    pixel = light / balance * electron + (sensor.read_noise_e * electron) ** 2
    cell = np.diag(pixel * balance**2 / np.array(CELL_PIXELS))
    matrix = sensor.colour_matrix
    water = np.clip(matrix @ light, 0, 1)
    spread = FLUCTUATION**2 * np.outer(water, water)
    return np.asarray(matrix @ cell @ matrix.T + spread + QUANTUM * np.eye(3))
