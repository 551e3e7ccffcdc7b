"""From light to the picture that a camera delivers: sensor, noise, picture processing."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.sim.control import CameraSettings
from chromadock.sim.response import Response

SATURATION = 78.0
"""lux s: exposure that saturates a sensor of ISO 1; ISO 12232:2019, saturation-based speed."""
LENS = 0.65
"""ISO 12232:2019: H = 0.65 L t / N^2, for a lens of usual transmittance and vignetting."""

TOE_OFFSET = 0.055
"""Of the tone curve; sRGB's own (IEC 61966-2-1)."""

_FULL = 65535
# Noise of either sign must last until the demosaicing has averaged it, so zero light stands
# this high in the 16 bit that the picture is processed in, as a chip's black level does.
_BLACK = 4096
_SPAN = _FULL - _BLACK


@dataclass(frozen=True, eq=False)
class Sensor:
    """A colour sensor with a Bayer mosaic (red at the top left) and its picture processing.

    Parameters
    ----------
    width, height
        Pixels, both even.
    response
        Spectral response; its ``daylight_raw`` is how unequal the raw channels are.
    f_number
        The lens's.
    base_iso
        Saturation-based speed at gain 1: there the strongest channel is full.
    full_well_e
        Electrons of a full pixel at gain 1.
    read_noise_e
        Electrons, standard deviation, at any gain.
    bits
        Of the converter.
    gamma
        Exponent of the tone curve; 2.4 is sRGB's curve.
    colour_matrix
        (3, 3) float64 on linear, white balanced R, G, B; rows sum to 1.
    jpeg_quality
        1..100, or None for a camera that sends its picture as it is.
    """

    width: int
    height: int
    response: Response
    f_number: float
    base_iso: float
    full_well_e: float
    read_noise_e: float
    bits: int
    gamma: float = 2.4
    colour_matrix: NDArray[np.float64] = field(default_factory=lambda: np.eye(3))
    jpeg_quality: int | None = None

    def level(self, settings: CameraSettings) -> float:
        """Share of saturation that 1 cd/m^2 of daylight gives in the strongest channel.

        ISO 12232:2019: H = 0.65 L t / N^2 over H_sat = 78 / ISO, ISO being proportional to
        the gain.
        """
        exposure = LENS * settings.exposure_s / self.f_number**2
        return exposure * self.base_iso * settings.gain / SATURATION

    def raw(
        self, light: NDArray[np.float32], settings: CameraSettings, rng: np.random.Generator
    ) -> NDArray[np.float32]:
        """(H, W) float32: the mosaic R G / G B as converted, share of full scale.

        Shot noise (normal approximation of Poisson's, variance = electrons) and read noise;
        clipped at 1.  Noise can make it negative: converters start below black.

        Parameters
        ----------
        light : (H, W, 3) float32 signal R, G, B, cd/m^2.
        """
        if light.shape != (self.height, self.width, 3):
            raise ValueError(f"light of shape {light.shape}, not {self.height}x{self.width}x3")
        red, green, blue = (self.level(settings) * self.response.daylight_raw).astype(np.float32)
        mosaic = np.empty((self.height, self.width), np.float32)
        np.multiply(light[0::2, 0::2, 0], red, out=mosaic[0::2, 0::2])
        np.multiply(light[0::2, 1::2, 1], green, out=mosaic[0::2, 1::2])
        np.multiply(light[1::2, 0::2, 1], green, out=mosaic[1::2, 0::2])
        np.multiply(light[1::2, 1::2, 2], blue, out=mosaic[1::2, 1::2])

        # In shares of full scale, of which one electron is gain / full_well_e.
        electron = np.float32(settings.gain / self.full_well_e)
        deviation = mosaic * electron
        deviation += (np.float32(self.read_noise_e) * electron) ** 2
        np.sqrt(deviation, out=deviation)
        deviation *= rng.standard_normal(mosaic.shape, dtype=np.float32)
        mosaic += deviation

        # One pass for the well and the converter, since both end at full scale.
        steps = np.float32(2**self.bits - 1)
        np.minimum(mosaic, np.float32(1), out=mosaic)
        mosaic *= steps
        np.rint(mosaic, out=mosaic)
        mosaic /= steps
        return mosaic

    def picture(
        self, light: NDArray[np.float32], settings: CameraSettings, rng: np.random.Generator
    ) -> NDArray[np.uint8]:
        """(H, W, 3) uint8 BGR: what the camera delivers.

        White balance follows the clipping, so a light that fills all channels comes out
        white, whatever its colour.

        Parameters
        ----------
        light : (H, W, 3) float32 signal R, G, B, cd/m^2, not negative.
        settings : exposure, gain and white balance of this frame.
        rng : of this frame alone, for the noise.
        """
        mosaic = self.raw(light, settings, rng)
        red, green, blue = (np.float32(gain * _SPAN) for gain in settings.white_balance)
        mosaic[0::2, 0::2] *= red
        mosaic[0::2, 1::2] *= green
        mosaic[1::2, 0::2] *= green
        mosaic[1::2, 1::2] *= blue
        mosaic += np.float32(_BLACK)
        np.clip(mosaic, 0, _FULL, out=mosaic)
        # OpenCV names a mosaic by its second row, from the second column: this is R G / G B.
        linear = cv2.demosaicing(mosaic.astype(np.uint16), cv2.COLOR_BayerBG2BGR)
        linear = cv2.transform(linear, self._to_linear)
        picture = np.take(tone_curve(self.gamma), np.asarray(linear, np.uint16))
        return picture if self.jpeg_quality is None else _through_jpeg(picture, self.jpeg_quality)

    @cached_property
    def _to_linear(self) -> NDArray[np.float64]:
        """(3, 4) float64: 16-bit B, G, R with the black level to 16-bit B, G, R from 0."""
        matrix = self.colour_matrix[::-1, ::-1] * (_FULL / _SPAN)
        return np.column_stack([matrix, -_BLACK * matrix.sum(axis=1)])


@lru_cache
def tone_curve(gamma: float) -> NDArray[np.uint8]:
    """(65536,) uint8: encoded level of each linear one, 0..65535.

    1.055 L^(1/gamma) - 0.055 above the point where its tangent passes through black, and
    that tangent below: for 2.4 the curve of sRGB (IEC 61966-2-1).
    """
    slope_end = TOE_OFFSET / ((1 + TOE_OFFSET) * (1 - 1 / gamma))  # L^(1/gamma) at the joint
    joint = slope_end**gamma
    slope = (1 + TOE_OFFSET) / gamma * slope_end / joint
    linear = np.arange(_FULL + 1) / _FULL
    power = (1 + TOE_OFFSET) * linear ** (1 / gamma) - TOE_OFFSET
    encoded = np.where(linear < joint, slope * linear, power)
    curve: NDArray[np.uint8] = np.rint(255 * encoded).astype(np.uint8)
    curve.setflags(write=False)
    return curve


def _through_jpeg(picture: NDArray[np.uint8], quality: int) -> NDArray[np.uint8]:
    """The picture as it comes out of a JPEG file of that quality, chroma at half size."""
    _, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), np.uint8)
