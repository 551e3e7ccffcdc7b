"""The front end of the robust detector in numpy and OpenCV, step by step: what
``host/native/front.h`` is held against.

It is written for being read, and is ten times as slow.  The tuned numbers that ``front.h`` does
not have stand here a second time: a test that took them from what it tests would miss a slip.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np

from chromadock.robust.frame import likeness
from chromadock.robust.frame.layout import BORDER, Layout
from chromadock.robust.frame.response import Response, linear
from chromadock.toml_file import read_toml

MIN_SNR, MIN_DARK_SNR, MAX_PEAKS, MAX_PROMISING = 3.0, 5.0, 112, 48
NEIGHBOURHOOD = 0.18  # of the frame's mean side
RING = np.array([(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)])


@dataclass(frozen=True)
class Scale:
    """One scale: ``light`` and ``added`` (h, w, 3), ``snr`` and ``best`` (h, w); ``dark`` (h, w):
    the largest of what the filters say less than nothing."""

    light: np.ndarray
    added: np.ndarray
    snr: np.ndarray
    best: np.ndarray
    dark: np.ndarray


def resized(image: np.ndarray, width: int, height: int) -> np.ndarray:
    """Means of what falls into each pixel of a smaller image."""
    return cv2.resize(image, (max(1, width), max(1, height)), interpolation=cv2.INTER_AREA)


def lights_of(frame: np.ndarray, layout: Layout) -> list[np.ndarray]:
    """Linear light of the cells of all scales."""
    finest = frame
    for _ in range(layout.cells[0].bit_length() - 1):
        finest = resized(finest, finest.shape[1] // 2, finest.shape[0] // 2)
    lights = [linear(finest)]
    while len(lights) < len(layout.cells):
        height, width = lights[-1].shape[:2]
        lights.append(resized(lights[-1], width // 2, height // 2))
    return lights


def covariance_of(light: np.ndarray) -> np.ndarray:
    """Of the fluctuation of cells, from second differences along rows."""
    rows = light[4::8].astype(np.float64)
    bent = (rows[:, 4:] + rows[:, :-4] - 2 * rows[:, 2:-2]).reshape(-1, 3)
    size = np.abs(bent).sum(axis=1)
    kept = bent[size <= 8 * size.mean()]
    return kept.T @ kept / (6 * len(kept)) + 5e-9 * np.eye(3)


def scale_of(light: np.ndarray, coarser: np.ndarray, cell: int, weights: np.ndarray) -> Scale:
    """What the filters (HUES, 3) make of one scale.

    The surround is the mean of cells of the ``coarser`` scale: it is smooth, and they are few.
    """
    height, width = light.shape[:2]
    wide = max(32 // cell, 4)
    added = light - cv2.resize(resized(coarser, width // wide, height // wide), (width, height))
    clipped = light.max(axis=2) >= 0.8
    snr, dark = [], []
    for hue, own in enumerate(weights):
        answer = np.where(clipped, added @ np.maximum(own, 0), added @ own)
        noise = resized(np.abs(answer), width // 8, height // 8)
        typical = max(np.sort(noise, axis=None)[noise.size // 2], 1e-3)
        noise = cv2.GaussianBlur(np.clip(noise, 0.9 * typical, 2.5 * typical), (0, 0), 1.5)
        noise = cv2.resize(noise, (width, height)) * np.sqrt(np.pi / 2)
        snr.append(answer / noise - (0.4 if hue else 0))
        dark.append(-answer / noise)
    # One filter's is kept with its sign, of several nothing where all say more.
    darkest = dark[0] if len(dark) == 1 else np.max([np.zeros_like(dark[0]), *dark], axis=0)
    return Scale(light, added, np.max(snr, axis=0), np.argmax(snr, axis=0), darkest)


def scales_of(frame: np.ndarray, response: Response) -> list[Scale]:
    """All scales of a frame, filtered as ``response`` has been."""
    lights = lights_of(frame, response.layout)
    cells = response.layout.cells
    seen = [response.weights[:1], *[response.weights] * (len(cells) - 1)]
    coarser = [*lights[1:], lights[-1]]
    return [scale_of(*each) for each in zip(lights, coarser, cells, seen, strict=True)]


def dark_of(scales: list[Scale], response: Response) -> list[Scale]:
    """The same scales for what takes light away: all light counts the other way round, and a cell's
    filter is the one that answers most to what it takes away."""
    return [
        Scale(
            -scale.light,
            -scale.added,
            scale.dark,
            np.argmax(-scale.added @ response.weights.T, axis=2),
            scale.snr,
        )
        for scale in scales
    ]


def is_darker(scale: Scale, y: int, x: int, response: Response) -> bool:
    """Whether a place takes light away by two standard deviations of a cell or more, in the channel
    where it takes most, and by half of that from six of eight places about it."""
    light = np.pad(scale.light, ((BORDER,) * 2, (BORDER,) * 2, (0, 0)), mode="edge")
    less = scale.light[y, x] - around(light, y, x, 3)
    lacks = scale.added[y, x] / np.sqrt(np.diag(response.covariance))
    c = int(lacks.argmax())
    return bool(lacks[c] >= 2 and (less[:, c] > 0.5 * scale.added[y, x, c]).sum() >= 6)


@dataclass(frozen=True)
class Peak:
    """One peak; ``looks`` (22,): in the order of ``front.h``."""

    scale: int
    xy: np.ndarray
    snr: float
    noise: float
    chroma: np.ndarray
    likeness: float
    looks: np.ndarray
    inside: float


def peaks_of(scales: list[Scale], response: Response) -> list[list[Peak]]:
    """Peaks of each scale, the strongest first; of what is dark none of the finest."""
    dark = response.sense < 0
    cells = response.layout.cells
    padded = [np.pad(s.snr, BORDER, mode="edge") for s in scales]
    tops = []
    for k, scale in enumerate(scales):
        if dark and k == 0:
            continue
        least = (MIN_DARK_SNR if dark else MIN_SNR) * max(cells[k] / cells[1], 1)
        for y, x in np.argwhere(scale.snr > 0.7 * least):
            inside = 0 < y < scale.snr.shape[0] - 1 and 0 < x < scale.snr.shape[1] - 1
            near = around(padded[k], y, x, 1)
            if not inside or scale.snr[y, x] < near.max() or scale.snr[y, x] in near[4:]:
                continue
            corners = [near[i] + near[i + 1] + near[(i + 2) % 8] for i in range(0, 8, 2)]
            strength = (scale.snr[y, x] + max(0, *corners)) / 2
            if strength >= least:
                tops.append((k, y, x, strength))
    tops = sorted(tops, key=lambda top: -top[3])[: 3 * MAX_PEAKS]
    found: list[list[Peak]] = [[] for _ in scales]
    for top in tops:
        mine = [(y, x) for k, y, x, _ in tops if k == top[0]]
        if dark and not is_darker(scales[top[0]], *top[1:3], response):
            continue
        if len(found[top[0]]) < MAX_PEAKS:
            found[top[0]].append(peak_of(top, scales, padded, mine, response))
    return found


def around(padded: np.ndarray, y: int, x: int, radius: int) -> np.ndarray:
    """(8, ...) values in eight directions, of an image with a border."""
    down, across = (BORDER + radius * RING + (y, x)).T
    return padded[down, across]


def peak_of(
    top: tuple[int, int, int, float],
    scales: list[Scale],
    padded: list[np.ndarray],
    others: list[tuple[int, int]],
    response: Response,
) -> Peak:
    """All that is told of a peak."""
    k, y, x, strength = top
    scale = scales[k]
    centre, added = scale.snr[y, x], scale.added[y, x].astype(np.float64)
    near = around(padded[k], y, x, 1)
    xx, yy = 2 * centre - near[0] - near[4], 2 * centre - near[2] - near[6]
    cross = (near[3] + near[7] - near[1] - near[5]) / 4
    shift = [
        np.clip((ahead - behind) / max(2 * bend, 1e-6), -0.5, 0.5)
        for ahead, behind, bend in ((near[0], near[4], xx), (near[2], near[6], yy))
    ]
    xy = (np.array([x, y]) + shift + 0.5) * response.layout.cells[k] - 0.5
    missing, channels = channels_of(scale, y, x, response)
    flatness = 1 - 4 * (xx * yy - cross**2) / max((xx + yy) ** 2, 1e-12)
    rings = [ring_of(padded[k], y, x, radius) for radius in (1, 2, 3)]
    looks = np.concatenate(
        [
            [flatness, saddle_of(scale.snr, y, x, others), missing],
            *rings,
            scales_about(padded, k, xy, response) / np.array([centre] * 4),
            channels,
        ]
    )
    looks[15:19][[k + 1 >= len(scales)] * 2 + [k + 2 >= len(scales), k == 0]] = -1
    weights = response.weights[scale.best[y, x]].astype(np.float64)
    if scale.light[y, x].max() >= 0.8:
        weights = np.maximum(weights, 0)
    return Peak(
        k,
        xy,
        strength,
        max(added @ weights, 1e-6) / centre,
        chroma_of(added, response),
        likeness_of(looks, strength, k),
        looks,
        inside_of(xy, response),
    )


def ring_of(padded: np.ndarray, y: int, x: int, radius: int) -> np.ndarray:
    """Mean, deviation, and sizes of the first two Fourier coefficients of a square ring."""
    side = np.arange(-radius, radius)
    edge = np.full(2 * radius, radius)
    down = np.concatenate([-edge, side, edge, -side]) + BORDER + y
    across = np.concatenate([side, edge, -side, -edge]) + BORDER + x
    values = padded[down, across] / padded[BORDER + y, BORDER + x]
    waves = np.fft.fft(values) / len(values)
    return np.array([values.mean(), values.std(), abs(waves[1]), abs(waves[2])])


def scales_about(
    padded: list[np.ndarray], k: int, xy: np.ndarray, response: Response
) -> np.ndarray:
    """(4,) signal to noise about a place at other scales; of no account where there is none."""

    def about(scale: int) -> np.ndarray:
        scale = min(max(scale, 0), len(padded) - 1)
        last = response.layout.shapes[scale][::-1] - 1
        cell = np.clip((xy + 0.5) / response.layout.cells[scale], 0, last).astype(int)
        x, y = cell + BORDER
        return padded[scale][y - 1 : y + 2, x - 1 : x + 2]

    coarser = about(k + 1)
    return np.array([coarser[1, 1], coarser.max(), about(k + 2)[1, 1], about(k - 1).max()])


def channels_of(scale: Scale, y: int, x: int, response: Response) -> tuple[float, np.ndarray]:
    """How much of the light is missing, and by how much each channel (3,) rises above the first
    ring, the strongest channel first."""
    light = np.pad(scale.light, ((BORDER,) * 2, (BORDER,) * 2, (0, 0)), mode="edge")
    behind = np.sort(around(light, y, x, 3), axis=0)
    deviation = np.sqrt(np.diag(response.covariance))
    missing = max(((behind[1] - scale.light[y, x]) / deviation).max(), 0)
    adds = max(((scale.light[y, x] - behind[6]) / deviation).max(), 0)
    added = np.abs(scale.added[y, x]) / deviation
    rises = (scale.light[y, x] - around(light, y, x, 1).mean(axis=0)) / deviation
    order = np.argsort(-added, kind="stable")
    return missing / (adds + missing + 1), rises[order] / max(added.max(), 1e-6)


def inside_of(xy: np.ndarray, response: Response) -> float:
    """Share of the square of a peak's neighbourhood that lies inside the frame, by a fine grid."""
    size = response.layout.shapes[0][::-1] * response.layout.cells[0]
    off = NEIGHBOURHOOD * np.sqrt(size.prod()) * (np.arange(2000) + 0.5 - 1000) / 1000
    along = xy[:, None] + off
    return float(((along > 0) & (along < size[:, None])).mean(axis=1).prod())


def saddle_of(snr: np.ndarray, y: int, x: int, others: list[tuple[int, int]]) -> float:
    """The least on the way to the higher peak that is joined best, over the peak."""
    best = 0.0
    for v, u in others:
        if snr[v, u] > snr[y, x] and np.hypot(v - y, u - x) < 12:
            part = np.arange(1, 8) / 8
            down = np.rint(y + (v - y) * part).astype(int)
            across = np.rint(x + (u - x) * part).astype(int)
            best = max(best, snr[down, across].min() / snr[y, x])
    return best


def chroma_of(added: np.ndarray, response: Response) -> np.ndarray:
    """Two angles off white."""
    along, *off = response.axes @ added
    size = np.hypot(*off)
    return np.array(off) * np.arctan2(size, along) / max(size, 1e-9)


@cache
def network() -> dict[str, np.ndarray]:
    """The weights of ``likeness.toml``."""
    table = read_toml(Path(likeness.__file__).with_name(likeness.FILE))
    return {name: np.array(values) for name, values in table.items()}


def likeness_of(looks: np.ndarray, snr: float, scale: int) -> float:
    """Log likelihood ratio of a lamp to clutter."""
    strength = np.log(min(snr, 60.0))
    base = np.array([strength, strength**2, scale == 0, scale == 2, scale >= 3, 1])
    low, high = np.repeat([[0, -1, -2], [1, 2, 2]], [3, 16, 3], axis=1)
    return float(weighed(np.concatenate([np.clip(looks, low, high), base])))


def weighed(every: np.ndarray) -> np.ndarray:
    """Log likelihood ratios of (..., 28) inputs and 1."""
    weights = network()
    sums = every @ weights["hidden"]
    odds = sums / (1 + np.abs(sums)) @ weights["of_hidden"] + every @ weights["of_inputs"]
    ratio = np.exp(odds - every[..., -len(weights["without"]) :] @ weights["without"])
    return np.asarray(np.log((0.98 * ratio + 0.02) / (0.98 + 0.02 * ratio)))


def promising_of(peaks: list[Peak]) -> list[int]:
    """Which peaks of a scale are searched for markers."""
    score = [p.likeness + 2 * np.log(p.snr) for p in peaks]
    return sorted(sorted(range(len(peaks)), key=lambda i: -score[i])[:MAX_PROMISING])
