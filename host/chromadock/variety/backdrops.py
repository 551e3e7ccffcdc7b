"""What is behind the dock: photographs of water, or water that is rendered."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np

from chromadock.errors import ChromadockError
from chromadock.sources.order import natural_key
from chromadock.sources.pictures import is_picture
from chromadock.variety.factors import variety
from chromadock.variety.halves import Half
from chromadock.variety.light import to_linear
from chromadock.variety.scene import Image, Scene

Room = tuple[tuple[float, float], tuple[float, float]]
"""Right and down, in shares of the width: the least and the greatest."""


@dataclass(frozen=True, slots=True)
class Backdrops:
    """Photographs to draw from.

    Parameters
    ----------
    plain
        Of nothing but water.
    other
        Of anything under water.
    """

    plain: tuple[Path, ...] = ()
    other: tuple[Path, ...] = ()

    @classmethod
    def of_folders(cls, plain: Path | None, other: Iterable[Path] = ()) -> Backdrops:
        """The pictures of folders, by name; a folder of water that is missing has none.

        Raises
        ------
        ChromadockError
            Where an ``other`` folder holds no picture.
        """
        return cls(pictures(plain) if plain else (), pictures_in(other))

    def half(self, half: Half) -> Backdrops:
        """Those photographs that are a half's."""
        return replace(
            self,
            plain=tuple(path for path in self.plain if half.has(path)),
            other=tuple(path for path in self.other if half.has(path)),
        )

    def choose(self, collection: str, rng: np.random.Generator) -> Path | None:
        """A photograph, from the other collection where the drawn one is empty; else None."""
        order = (self.plain, self.other) if collection == "plain" else (self.other, self.plain)
        chosen = next(filter(None, order), ())
        return chosen[int(rng.integers(len(chosen)))] if chosen else None


def pictures(folder: Path) -> tuple[Path, ...]:
    """The pictures in a folder in the order of their names."""
    if not folder.is_dir():
        return ()
    files = [path for path in folder.iterdir() if is_picture(path)]
    return tuple(sorted(files, key=lambda path: natural_key(path.name)))


def pictures_in(folders: Iterable[Path]) -> tuple[Path, ...]:
    """The pictures of folders that a user has named, each folder's in the order of their names.

    Raises
    ------
    ChromadockError
        Where a folder itself holds none: figures would be of fewer than the user believes.
    """
    found: list[Path] = []
    for folder in folders:
        here = pictures(folder)
        if not here:
            raise ChromadockError(f"{folder}: no pictures there: name the folder that holds them")
        found += here
    return tuple(found)


def backdrop(
    scene: Scene,
    size: tuple[int, int],
    moved: tuple[float, float] = (0.0, 0.0),
    scale: float = 1.0,
    room: Room = ((0.0, 0.0), (0.0, 0.0)),
) -> Image:
    """(H, W, 3) float32 linear RGB by full daylight, 0..1.

    Parameters
    ----------
    size : width and height, pixels.
    moved : right and down, in shares of the width: how far the camera's turn shifts it.
    scale : by how much it is larger than at first.
    room : the least and the greatest of all that it is ``moved`` by.  It is enlarged to have so
        much to spare: what is mirrored at its edge would look like things two by two.
    """
    rng = np.random.default_rng([scene.seed, scene.index, 2])
    place = rng.uniform(0, 1, 2)  # drawn for both kinds, so that neither shifts the other's
    if scene.photograph is None:
        seen = _water(scene, size, rng)
    else:
        seen = read(scene.photograph)
        if scene.mirrored:
            seen = seen[:, ::-1]
    high, wide = seen.shape[:2]
    low, high_end = (size[0] * np.array(end) for end in room)
    across = np.array(size) + high_end - low
    fit = max(across[0] / wide, across[1] / high) * scene.zoom * scale
    left, top = (
        high_end + place * (np.multiply((wide, high), fit) - across) - np.multiply(moved, size[0])
    )
    turn = np.array([[fit, 0, fit / 2 - 0.5 - left], [0, fit, fit / 2 - 0.5 - top]])
    fitted = cv2.warpAffine(
        seen,
        turn,
        size,
        flags=cv2.INTER_LINEAR if fit > 0.6 else cv2.INTER_AREA,
        borderMode=cv2.BORDER_REFLECT_101,
    )
    return to_linear(np.asarray(fitted, np.uint8))


@lru_cache(maxsize=32)
def read(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """(H, W, 3) uint8 RGB.

    Raises
    ------
    ChromadockError
        Where it is no picture.
    """
    seen = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if seen is None:
        raise ChromadockError(f"{path}: cannot be read as a picture: remove it")
    return np.ascontiguousarray(seen[..., ::-1], np.uint8)


def _water(
    scene: Scene, size: tuple[int, int], rng: np.random.Generator
) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """(h, w, 3) uint8 RGB: a gradient, clouds of several sizes, maybe glitter of the surface."""
    width, height = (max(side // 2, 160) for side in size)
    ends = variety().waters[scene.waters]
    down = np.linspace(0, 1, height, dtype=np.float32)[:, None] ** rng.uniform(0.5, 1.5)
    clouds = np.zeros((height, width), np.float32)
    for cells in (3, 6, 12, 24):
        coarse = rng.standard_normal((cells, cells + 1)).astype(np.float32)
        clouds += cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC) / cells
    share = np.clip(down + 0.3 * clouds, 0, 1)[..., None]
    seen = np.array(ends.top) * (1 - share) + np.array(ends.bottom) * share
    seen *= rng.uniform(0.85, 1.15, 3)
    if scene.surface == "glitter":
        seen += _glitter(width, height, rng)[..., None] * np.array([200, 220, 210])
    return np.asarray(np.clip(seen, 0, 255), np.uint8)


def _glitter(width: int, height: int, rng: np.random.Generator) -> Image:
    """(h, w) 0..1: flat specks that get rarer and fainter below the surface."""
    waves = rng.standard_normal((height, max(width // 4, 1))).astype(np.float32)
    wide = cv2.resize(cv2.GaussianBlur(waves, (0, 0), 0.8), (width, height))
    depth = np.linspace(0, 1, height, dtype=np.float32)[:, None] / rng.uniform(0.25, 0.5)
    return np.clip(wide - 0.3 - depth, 0, 1).astype(np.float32)
