"""A night of twelve hours in fast time: .venv/bin/python tools/night.py, by `make night`.

The firmware core decides on frames of water that goes dark and bright again, lit by the dock's
own lamps and now and then by a vehicle's.  Prints, for each share of own light, how far the hue
shown was from what the water alone asks for, how much of the lamps' light was lost to looks at
the dark, and how long they were out at most.  Exit status 1: a figure is over its limit.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import sys
from collections import deque
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from chromadock.method import FALLBACK_HUE, HUE_RANGE
from chromadock_firmware import Dock, Settings, decide, lib

PERIOD_MS = 80
READ_SHARE = 0.9
"""Of the period: from the first row that is read to the last.  Each is exposed for a period."""
SIZE = (24, 32)
GAMMA = 2.2
NOISE = 3.0
"""Standard deviation of a pixel, of 255."""

WATERS = {"sea": (0.08, 0.45, 1.0), "lake": (0.3, 1.0, 0.2)}
OWN_LIGHT = (0.0, 0.003, 0.01, 0.05)
MAPPINGS = ("ternary", "complement")
DAY, NIGHT = 0.4, 4e-6
"""Of full scale."""
DUSK_S, DECADE_S = 300.0, 600.0
"""When light begins to fall, and how long it takes to fall to a tenth; at dawn as at dusk."""
TWILIGHT = (600.0, 1800.0)
"""The part of a night in which the water goes dark, s."""
LAMP_EVERY_S, LAMP_S = 1900.0, 20.0
LAMP = (0.03, 0.05, 0.045)

MOST_DEG, MOST_DARK_S, MOST_LOST = 5.0, 0.2, 0.02
CHANGE_S = 120.0
"""So long after the water got a hue or lost it the dock may show either."""


@dataclass
class Night:
    """What came of one run.

    Attributes:
        worst_deg: of the hue shown, from what the water asks for.
        worst_s: when that was.
        lost: share of the time in which the lamps were out.
        longest_s: that they were out at a stretch.
        looks: how often.
        hues: seconds in which the water had a hue by the dock's own judgement.
    """

    worst_deg: float = 0.0
    worst_s: float = 0.0
    lost: float = 0.0
    longest_s: float = 0.0
    looks: int = 0
    hues: float = 0.0

    def good(self) -> bool:
        """Tell whether every figure is within its limit."""
        return (
            self.worst_deg <= MOST_DEG and self.longest_s <= MOST_DARK_S and self.lost <= MOST_LOST
        )


@dataclass
class Scene:
    """Water and camera: light of day at ``time_s``, both lamps, and the frame that comes of it."""

    water: NDArray[np.float64]
    night_s: float
    rng: np.random.Generator
    fields: NDArray[np.float64] = field(init=False)
    fall: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        self.fields = NOISE * self.rng.standard_normal((64, *SIZE, 3))
        self.fall = np.linspace(1.15, 0.85, SIZE[0])[:, None, None]

    def daylight(self, time_s: float) -> float:
        """Dusk at the start, dawn at the end."""
        since_s = min(time_s, self.night_s - time_s) - DUSK_S
        return max(NIGHT, float(DAY * 10 ** -max(0.0, since_s / DECADE_S)))

    def passing(self, time_s: float) -> float:
        """A vehicle's lamp, 0 where none passes, up to 1."""
        since = time_s % LAMP_EVERY_S - (LAMP_EVERY_S - LAMP_S)
        return max(0.0, math.sin(math.pi * since / LAMP_S)) if since > 0 else 0.0

    def frame(self, time_s: float, own: NDArray[np.float64], lamp: float) -> bytes:
        """RGB565; ``own`` (rows, 3) is the light of the dock's lamps on each row."""
        light = self.daylight(time_s) * self.fall * self.water
        light = light + own[:, None, :] + lamp * np.array(LAMP)
        code = 255.0 * np.minimum(light, 1.0) ** (1 / GAMMA)
        noisy = np.clip(code + self.fields[self.rng.integers(len(self.fields))], 0, 255)
        r, g, b = np.moveaxis(noisy.astype(np.uint16), -1, 0)
        return ((r >> 3) << 11 | (g >> 2) << 5 | b >> 3).astype(">u2").tobytes()


class Lamps:
    """What the dock's lamps gave, and how long they were out."""

    def __init__(self) -> None:
        self.driven: deque[tuple[float, NDArray[np.float64]]] = deque(
            [(-math.inf, np.zeros(3))], maxlen=12
        )
        self.dark_since: float | None = None
        self.out_s: list[float] = []

    def drive(self, duties: tuple[int, int, int], now_s: float) -> None:
        """From ``now_s`` on."""
        lamps = np.array(duties) / lib.LED_FULL
        if (lamps == self.driven[-1][1]).all():
            return
        was_lit = self.driven[-1][1].any()
        self.driven.append((now_s, lamps))
        if not lamps.any():
            self.dark_since = now_s
        elif not was_lit and self.dark_since is not None:
            self.out_s.append(now_s - self.dark_since)
            self.dark_since = None

    def on_rows(self, now_s: float) -> NDArray[np.float64]:
        """Their mean over each row's exposure, of a frame that is read up to ``now_s``: (rows, 3),
        or (1, 3) where all rows are alike."""
        period_s = PERIOD_MS / 1000
        if self.driven[-1][0] <= now_s - 2 * period_s:
            return self.driven[-1][1][None, :]
        ends = now_s - READ_SHARE * period_s * np.linspace(1, 0, SIZE[0])
        total = np.zeros((SIZE[0], 3))
        until = now_s
        for at, lamps in reversed(self.driven):
            lit = np.minimum(ends, until) - np.maximum(ends - period_s, at)
            total += np.clip(lit, 0, None)[:, None] * lamps
            until = at
            if at <= ends[0] - period_s:
                break
        return total / period_s


def run(
    hours: float,
    water: str,
    own: float,
    mapping: str,
    part_s: tuple[float, float] | None = None,
    seed: int = 1,
) -> Night:
    """One night of so many hours, or only the part of it from one time to another."""
    scene = Scene(np.array(WATERS[water]), 3600 * hours, np.random.default_rng(seed))
    dock = Dock(Settings(mapping=mapping, led_common_anode=False))
    lamps, result = Lamps(), Night()
    asked, asked_s, changed_s = FALLBACK_HUE, -math.inf, -math.inf
    age_ms = round((1 + READ_SHARE) * PERIOD_MS)
    first_s, last_s = part_s or (0.0, 3600 * hours)
    for number in range(int(1000 * first_s / PERIOD_MS), int(1000 * last_s / PERIOD_MS)):
        now_ms = number * PERIOD_MS
        now_s = now_ms / 1000
        data = scene.frame(now_s, own * lamps.on_rows(now_s), scene.passing(now_s))
        dock.frame(data, SIZE[1], SIZE[0], "rgb565", now_ms, age_ms)
        lamps.drive(dock.led_duties(now_ms), now_s)
        for turn_ms in range(now_ms + 5, now_ms + PERIOD_MS, 5) if dock.looks else ():
            lamps.drive(dock.led_duties(turn_ms), turn_ms / 1000)
        if now_s - asked_s >= 5:
            asks = _asks(scene, now_s, mapping)
            if (asks is None) != (asked is None):
                changed_s = now_s
            asked, asked_s = asks, now_s
            result.hues += 5.0 if asked is not None else 0.0
        if now_s - changed_s > CHANGE_S:
            shown = FALLBACK_HUE if asked is None else asked
            apart = _apart_deg(dock.marker_hue, shown)
            if apart > result.worst_deg:
                result.worst_deg, result.worst_s = apart, now_s
    result.lost = sum(lamps.out_s) / (last_s - first_s)
    result.longest_s = max(lamps.out_s, default=0.0)
    result.looks = len(lamps.out_s)
    return result


def _asks(scene: Scene, now_s: float, mapping: str) -> int | None:
    """Marker for the water alone, without any lamp: the mean of nine frames; None: no hue."""
    dark = np.zeros((SIZE[0], 3))
    decisions = [
        decide(scene.frame(now_s, dark, 0.0), SIZE[1], SIZE[0], "rgb565", mapping) for _ in range(9)
    ]
    if sum(d.background["meaningful"] for d in decisions) < 5:
        return None
    angles = np.array([d.marker_hue for d in decisions if d.background["meaningful"]])
    turn = np.exp(2j * np.pi * angles / HUE_RANGE).sum()
    return round(float(np.angle(turn)) / (2 * np.pi) * HUE_RANGE) % HUE_RANGE


def _apart_deg(a: int, b: int) -> float:
    steps = (a - b) % HUE_RANGE
    return 360 / HUE_RANGE * min(steps, HUE_RANGE - steps)


def main() -> int:
    """Run all nights, print, and return the exit status."""
    parser = argparse.ArgumentParser(description="Nights of a dock in fast time.")
    parser.add_argument("--hours", type=float, default=12.0, help="of each night (12)")
    hours = parser.parse_args().hours
    pairs = zip(WATERS, MAPPINGS, strict=True)
    plans = [(hours, water, own, mapping) for (water, mapping), own in product(pairs, OWN_LIGHT)]
    print("water  own light  mapping     worst hue      light lost  longest dark  looks")
    bad = 0
    with multiprocessing.Pool() as pool:
        nights = [pool.apply_async(run, plan) for plan in plans]
        for (_, water, own, mapping), one in zip(plans, nights, strict=True):
            night = one.get()
            bad += not night.good()
            print(
                f"{water:5}  {100 * own:6.1f} %   {mapping:10}  {night.worst_deg:5.1f} deg "
                f"at {night.worst_s / 3600:5.2f} h  {100 * night.lost:6.2f} %  "
                f"{night.longest_s:8.3f} s  {night.looks:6}{'' if night.good() else '  TOO MUCH'}",
                flush=True,
            )
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
