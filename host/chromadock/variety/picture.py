"""From linear light to the picture that a camera delivers; JPEG comes last."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.variety.light import automatic_gain
from chromadock.variety.scene import Image, Scene

READ_VARIANCE = 2e-6
"""Of the sensor's noise in darkness, of full scale squared."""
_FULL = 65535
_BLACK = 2048  # zero light, so that noise of either sign lasts until the demosaicing
_SPAN = _FULL - _BLACK
_SAMPLING = {"4:2:0": 0x221111, "4:4:4": 0x111111}  # cv2.IMWRITE_JPEG_SAMPLING_FACTOR_...


def taken(
    light: Image, scene: Scene, rng: np.random.Generator, interlaced: bool
) -> NDArray[np.uint8]:
    """(H, W, 3) linear RGB through lens, sensor and picture processing, uint8 BGR.

    Parameters
    ----------
    rng : of this frame alone, for the noise.
    interlaced : whether every other row is of another moment.
    """
    if interlaced:
        light = two_fields(light, scene)
    light = _vignetted(_blurred(light, scene), scene.vignette)
    gain = scene.exposure_gain
    if scene.exposure == "automatic":
        gain = automatic_gain(light[::8, ::8], scene.target)
    linear = _demosaiced(_raw(light, gain, scene.shot_noise, rng))
    if scene.white_balance == "automatic":
        linear = _balanced(linear, scene.balance)
    picture = np.take(_tone_curve(scene.gamma, scene.s_curve), linear, mode="clip")
    noise = rng.standard_normal(picture.shape, np.float32)
    noise *= np.float32(scene.code_noise)
    picture += noise
    np.clip(np.rint(picture, out=picture), 0, 255, out=picture)
    return through_jpeg(picture.astype(np.uint8), scene.jpeg_quality, scene.subsampling)


def two_fields(light: Image, scene: Scene) -> Image:
    """Even rows as they were half a shift before, odd rows as they are half a shift later."""
    angle = np.radians(scene.shake_deg)
    half = (
        0.5 * scene.field_shift_px * light.shape[1] / 640 * np.array([np.cos(angle), np.sin(angle)])
    )
    fields = [
        cv2.warpAffine(
            light,
            np.array([[1, 0, sign * half[0]], [0, 1, sign * half[1]]]),
            light.shape[1::-1],
            borderMode=cv2.BORDER_REPLICATE,
        )
        for sign in (-1, 1)
    ]
    fields[0][1::2] = fields[1][1::2]
    return np.asarray(fields[0], np.float32)


def through_jpeg(picture: NDArray[np.uint8], quality: int, subsampling: str) -> NDArray[np.uint8]:
    """The picture as it comes out of a JPEG file; ``subsampling`` of its chroma."""
    options = [cv2.IMWRITE_JPEG_QUALITY, quality]
    options += [cv2.IMWRITE_JPEG_SAMPLING_FACTOR, _SAMPLING[subsampling]]
    _, data = cv2.imencode(".jpg", picture, options)
    return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), np.uint8)


def _blurred(light: Image, scene: Scene) -> Image:
    """Out of focus, and shaken along a line while the shutter was open."""
    scale = light.shape[1] / 640
    shake, sigma = scene.shake_px * scale, scene.defocus_px * scale**0.5
    side = 2 * int(np.ceil(shake / 2 + 1)) + 1
    kernel = np.zeros((side, side), np.float32)
    angle = np.radians(scene.shake_deg)
    steps = np.linspace(-0.5, 0.5, 33) * shake
    for x, y in zip(steps * np.cos(angle), steps * np.sin(angle), strict=True):
        column, row = x + side // 2, y + side // 2
        i, j = int(row), int(column)
        a, b = row - i, column - j
        kernel[i : i + 2, j : j + 2] += np.outer((1 - a, a), (1 - b, b))
    if shake > 0.3:
        kernel /= kernel.sum()
        shaken = cv2.filter2D(light, -1, kernel, borderType=cv2.BORDER_REPLICATE)
        light = np.asarray(shaken, np.float32)
    return np.asarray(cv2.GaussianBlur(light, (0, 0), sigma), np.float32)


def _vignetted(light: Image, vignette: float) -> Image:
    """Darker towards the corners, by ``vignette`` there."""
    height, width = light.shape[:2]
    x = np.linspace(-1, 1, width, dtype=np.float32)
    y = np.linspace(-1, 1, height, dtype=np.float32)[:, None] * np.float32(height / width)
    corner = 1 + (height / width) ** 2
    return light * (1 - np.float32(vignette / corner) * (x**2 + y**2))[..., None]


def _raw(light: Image, gain: float, shot_noise: float, rng: np.random.Generator) -> Image:
    """(H, W) mosaic R G / G B with its noise, clipped at full scale."""
    raw = light[..., 1].copy()
    raw[::2, ::2], raw[1::2, 1::2] = light[::2, ::2, 0], light[1::2, 1::2, 2]
    raw *= np.float32(gain)
    # The more a sensor amplifies, the fewer electrons a full pixel has.
    electron = np.float32(shot_noise * max(gain, 1.0))
    deviation = np.sqrt(
        np.clip(raw, 0, 1) * electron + np.float32(READ_VARIANCE * max(gain, 1) ** 2)
    )
    raw += deviation * rng.standard_normal(raw.shape, np.float32)
    return np.minimum(raw, 1, out=raw)


def _demosaiced(raw: Image) -> NDArray[np.uint16]:
    """(H, W, 3) uint16 BGR, linear from zero light at 0."""
    levels = np.clip(raw * _SPAN + _BLACK, 0, _FULL).astype(np.uint16)
    # OpenCV names a mosaic by its second row, from the second column: this is R G / G B.
    whole = np.asarray(cv2.demosaicing(levels, cv2.COLOR_BayerBG2BGR), np.uint16)
    return np.maximum(whole, _BLACK) - np.uint16(_BLACK)


def _balanced(linear: NDArray[np.uint16], strength: float) -> NDArray[np.uint16]:
    """Grey world: the channels' means made alike, by all or a part."""
    means = np.maximum(np.array(cv2.mean(linear[::4, ::4])[:3]), 1)
    gains = np.clip((means[1] / means) ** strength, 0.4, 4)
    return np.asarray(cv2.transform(linear, np.diag(gains)), np.uint16)


def _tone_curve(gamma: float, s_curve: float) -> NDArray[np.float32]:
    """(65536,) float32: encoded 0..255 of each linear level; an S has more contrast midway."""
    power = np.minimum(np.arange(_FULL + 1) / _SPAN, 1) ** (1 / gamma)
    curved = power + s_curve * 0.5 * (power**2 * (3 - 2 * power) - power)
    return (255 * curved).astype(np.float32)
