"""Between 8-bit pictures and linear light; the water's colours; what lamps shine."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.colour.background import background_colour
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import smooth, working_image
from chromadock.variety.scene import Floats, Image, Scene

PHOTOGRAPH_GAMMA = 2.2
CROSSTALK = np.array([[0, 0.05, 0.02], [0.10, 0, 0.15], [0.02, 0.2, 0]])
"""What an LED of one colour gives in the other channels: rows are the camera's R, G, B."""
FIXED_COLOURS = {
    "blue": (0, 0, 255),
    "green": (0, 255, 0),
    "white": (255, 255, 255),
    "red": (255, 0, 0),
}

_LINEAR = (np.arange(256, dtype=np.float32) / 255) ** PHOTOGRAPH_GAMMA


def to_linear(rgb: NDArray[np.uint8]) -> Image:
    """8-bit encoded colour to linear light 0..1, float32 of the same shape."""
    return np.asarray(cv2.LUT(rgb, _LINEAR), np.float32)


def encoded(light: Image) -> NDArray[np.uint8]:
    """Linear light to 8 bits, clipped at full scale."""
    return np.asarray(np.rint(255 * np.clip(light, 0, 1) ** (1 / PHOTOGRAPH_GAMMA)), np.uint8)


@dataclass(frozen=True, eq=False, slots=True)
class Water:
    """Linear RGB, each (3,): the water's own colour (the veil), the light on things in it, the
    beam attenuation, 1/m."""

    veil: Floats
    ambient: Floats
    attenuation: Floats

    def seen(self, reflectance: Floats, range_m: float) -> Floats:
        """(3,) light of a surface at a distance."""
        through = np.exp(-self.attenuation * range_m)
        return np.asarray(reflectance * self.ambient * through + self.veil * (1 - through))


def water_and_lamp(scene: Scene, backdrop: Image) -> tuple[Water, tuple[int, int, int]]:
    """The water of a backdrop (H, W, 3), linear, and the pure RGB that the dock's LEDs show.

    The mapping's choice is for the colour that the vehicle's camera sees with its exposure, but
    before its white balance: a dock's camera has that locked.
    """
    small = np.asarray(cv2.resize(backdrop, (320, 240), interpolation=cv2.INTER_AREA), np.float32)
    gain = scene.exposure_gain
    if scene.exposure == "automatic":
        gain = automatic_gain(small, scene.target)
    seen = background_colour(smooth(working_image(encoded(np.asarray(small * gain, np.float32)))))
    mean = to_linear(np.array([[seen.rgb]], np.uint8))[0, 0].astype(np.float64) / gain
    veil = np.maximum(mean, 1e-5)
    # Daylight from above is whiter than what the water scatters.
    ambient = 2.0 * (0.6 * veil + 0.4 * veil.max())
    if scene.colour == "mapped":
        rgb = rgb_from_hsv(marker_hue(seen, scene.mapping), 255, 255)
    else:
        rgb = FIXED_COLOURS[scene.colour]
    return Water(veil, ambient, np.array(scene.attenuation)), rgb


def automatic_gain(light: Image, target: float) -> float:
    """The exposure that brings the mean to a target, encoded 0..1; cameras end at 16 times."""
    mean = float(np.clip(light, 0, 4).mean())
    return float(np.clip(target**PHOTOGRAPH_GAMMA / max(mean, 1e-6), 0.1, 16))


def lamp_light(rgb: tuple[int, int, int], radiance: float, crosstalk: float) -> Floats:
    """(3,) radiance of an LED's face in a camera's channels, full scales.

    Parameters
    ----------
    crosstalk : 0 for a camera that corrects its colours in full, 1 for one that does not.
    """
    pure = (np.array(rgb) / 255) ** PHOTOGRAPH_GAMMA
    light = (np.eye(3) + crosstalk * CROSSTALK) @ pure
    return np.asarray(radiance * light / light.max(), np.float64)
