"""What can differ between scenes, and drawing it: ``variety.toml`` and one seed."""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from functools import cache
from importlib import resources

import numpy as np
from pydantic import BaseModel, ConfigDict

from chromadock.errors import ChromadockError
from chromadock.toml_file import read_toml

FILE = "variety.toml"

DERIVED = ("daylight_level", "exposure_gain")
"""Factors whose bounds another gives."""

Range = tuple[float, float]
Fixed = str | float


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class CameraEntry(_Strict):
    """A camera: width and height, fx and fy, cx and cy, all in pixels, and its lens."""

    size: tuple[int, int]
    focal: Range
    centre: Range
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)
    interlaced: bool = False
    noise: float = 1.0


class DockEntry(_Strict):
    """Markers in shares of the dock's width, the pairs that bars join, a width if it is fixed."""

    points: tuple[tuple[float, float, float], ...]
    bars: tuple[tuple[int, int], ...]
    width_m: float | None = None


class WaterColours(_Strict):
    """RGB of rendered water at the frame's top and bottom, encoded, 0..255."""

    top: tuple[float, float, float]
    bottom: tuple[float, float, float]


class Variety(_Strict):
    """All of ``variety.toml``."""

    shares: dict[str, dict[str, float]]
    uniform: dict[str, Range]
    logarithmic: dict[str, Range]
    each: dict[str, Range]
    daylight: dict[str, Range]
    locked: dict[str, Range]
    waters: dict[str, WaterColours]
    cameras: dict[str, CameraEntry]
    docks: dict[str, DockEntry]


@cache
def variety() -> Variety:
    """The packaged file."""
    with resources.as_file(resources.files(__package__) / FILE) as path:
        return Variety.model_validate(read_toml(path))


class Draws:
    """The draws of one scene: each factor has a stream of its own.

    So a factor that is fixed, or one that is added later, leaves the others as they are.

    Parameters
    ----------
    seed, index
        Which scene.
    fixed
        Factors that are not drawn, by name.
    """

    def __init__(self, seed: int, index: int, fixed: Mapping[str, Fixed]) -> None:
        self._key = (seed, index)
        self._fixed = dict(fixed)

    def rng(self, name: str) -> np.random.Generator:
        """The stream of one factor."""
        return np.random.default_rng([*self._key, zlib.crc32(name.encode())])

    def share(self, name: str, also: tuple[str, ...] = ()) -> str:
        """One of the choices of ``[shares]``; ``also`` may be fixed but is never drawn."""
        return self.ranked(name, also)[0]

    def ranked(self, name: str, also: tuple[str, ...] = ()) -> list[str]:
        """All choices in a drawn order, the drawn one first; only one where it is fixed."""
        shares = variety().shares[name]
        if name in self._fixed:
            value = self._fixed[name]
            value = value if isinstance(value, str) else f"{value:g}"
            if value not in (*shares, *also):
                raise ChromadockError(
                    f"{name} = {value}: it must be one of {', '.join((*shares, *also))}"
                )
            return [value]
        names = list(shares)
        weights = np.array([shares[n] for n in names])
        drawn = self.rng(name).choice(
            len(names), np.count_nonzero(weights), False, weights / weights.sum()
        )
        return [names[i] for i in drawn]

    def between(self, name: str) -> float:
        """A number of ``[uniform]`` or ``[logarithmic]``."""
        if name in self._fixed:
            return self._number(name)
        if name in variety().uniform:
            return float(self.rng(name).uniform(*variety().uniform[name]))
        low, high = variety().logarithmic[name]
        return math.exp(self.rng(name).uniform(math.log(low), math.log(high)))

    def bounds(self, name: str) -> Range:
        """Of a number that is drawn again and again until it suits: one number if it is fixed."""
        if name in self._fixed:
            return (self._number(name),) * 2
        return variety().uniform[name]

    def of(self, name: str, bounds: Range) -> float:
        """A number evenly drawn in its logarithm, of bounds that another factor gives."""
        if name in self._fixed:
            return self._number(name)
        return math.exp(self.rng(name).uniform(*np.log(bounds)))

    def several(self, name: str, count: int) -> tuple[float, ...]:
        """Independent numbers of ``[each]``."""
        return tuple(self.rng(name).uniform(*variety().each[name], count).tolist())

    def _number(self, name: str) -> float:
        try:
            return float(self._fixed[name])
        except ValueError:
            raise ChromadockError(f"{name} = {self._fixed[name]}: it must be a number") from None


def check_names(fixed: Mapping[str, Fixed]) -> None:
    """Refuse to fix what is no factor."""
    every = variety()
    known = (*every.shares, *every.uniform, *every.logarithmic, *DERIVED)
    for name in fixed:
        if name not in known:
            raise ChromadockError(f"{name}: no such factor; there are {', '.join(sorted(known))}")
