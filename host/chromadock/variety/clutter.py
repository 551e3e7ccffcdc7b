"""What stands or shines about the dock."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from chromadock.camera import CameraModel
from chromadock.variety.factors import Draws
from chromadock.variety.scene import Floats, Thing

KINDS = ("buoys", "posts", "boxes", "single_lamp", "diver", "own_colour", "other_dock")
"""Factors of ``variety.toml``, each on its own."""
CLEARANCE = 0.02
"""Between what stands nearer than the dock and a lamp, in shares of the width."""


def draw_things(
    draws: Draws, camera: CameraModel, R: Floats, t: Floats, lamps_px: Floats, needed: bool
) -> tuple[str, tuple[Thing, ...]]:
    """The kinds that were drawn, as one text, and their things; nothing hides a lamp.

    Parameters
    ----------
    R, t : T_camera_dock.
    lamps_px : (N, 2) pixels of the dock's lamps.
    needed : whether there has to be a lamp that is no dock's: where there is no dock.
    """
    kinds = [kind for kind in KINDS if draws.share(kind) == "some"]
    if needed and not {"single_lamp", "diver", "other_dock"} & set(kinds):
        kinds.append("single_lamp" if draws.rng("needed").uniform() < 0.5 else "diver")
    things: list[Thing] = []
    for kind in kinds:
        rng = draws.rng(f"{kind}: what")
        room = _Room(camera, R, t, rng)
        things += [
            thing for thing in _MAKERS[kind](room) if not _hides(thing, camera, R, t, lamps_px)
        ]
    return " ".join(kinds) or "none", tuple(things)


class _Room:
    """Places in view of the camera, near and far."""

    def __init__(self, camera: CameraModel, R: Floats, t: Floats, rng: np.random.Generator) -> None:
        self.rng, self._camera, self._R, self._t = rng, camera, R, t
        self.range_m = float(t[2])

    def place(self, nearest: float = 0.8, farthest: float = 1.8) -> tuple[Floats, float]:
        """(3,) camera frame, and z; within so many times the dock's distance."""
        z = self.range_m * self.rng.uniform(nearest, farthest)
        pixel = self.rng.uniform((0, 0), (self._camera.width, self._camera.height))
        ray = self._camera.undistort([pixel])[0]
        return z * np.array([*ray, 1.0]), float(z)

    def size(self, z: float, least: float, most: float) -> float:
        """Metres of what is so large in shares of the frame's width."""
        share = np.exp(self.rng.uniform(np.log(least), np.log(most)))
        return float(share * self._camera.width / self._camera.matrix[0, 0] * z)

    def in_dock(self, place: Floats) -> tuple[float, float, float]:
        """From the camera's frame to the dock's."""
        x, y, z = ((place - self._t) @ self._R).tolist()
        return x, y, z


def _hides(thing: Thing, camera: CameraModel, R: Floats, t: Floats, lamps_px: Floats) -> bool:
    place = R @ np.array(thing.place) + t
    if thing.kind == "lamp" or place[2] > t[2] or not len(lamps_px):
        return False
    pixel = camera.project([place])[0]
    size = camera.matrix[0, 0] * thing.size_m / place[2]
    apart = np.abs(lamps_px - pixel)
    if thing.kind == "post":
        apart[:, 1] = 0
    reach = size * max(1.0, thing.aspect) * 1.5 + CLEARANCE * camera.width
    return bool((np.hypot(*apart.T) < reach).any())


def _colour(rng: np.random.Generator) -> tuple[float, float, float]:
    """Any reflectance; a third are greys."""
    level = rng.uniform(0.03, 0.9)
    hue = np.ones(3) if rng.uniform() < 0.33 else rng.uniform(0, 1, 3) ** 1.5
    r, g, b = (level * hue / hue.max()).tolist()
    return r, g, b


def _buoys(room: _Room) -> Iterator[Thing]:
    for _ in range(room.rng.integers(1, 5)):
        place, z = room.place()
        yield Thing("disc", room.in_dock(place), room.size(z, 0.006, 0.06), _colour(room.rng))


def _boxes(room: _Room) -> Iterator[Thing]:
    for _ in range(room.rng.integers(1, 4)):
        place, z = room.place()
        size, aspect = room.size(z, 0.006, 0.03), room.rng.uniform(0.4, 3)
        yield Thing("box", room.in_dock(place), size, _colour(room.rng), aspect)


def _posts(room: _Room) -> Iterator[Thing]:
    for _ in range(room.rng.integers(1, 4)):
        place, z = room.place(1.05, 1.6)
        yield Thing("post", room.in_dock(place), room.size(z, 0.002, 0.012), _colour(room.rng))


def _lamp(
    room: _Room, place: Floats, z: float, colour: tuple[float, float, float], own: bool = False
) -> Thing:
    radius, radiance = room.size(z, 0.002, 0.02), float(np.exp(room.rng.uniform(1, 3.2)))
    return Thing("lamp", room.in_dock(place), radius, colour, own_colour=own, radiance=radiance)


def _single_lamp(room: _Room) -> Iterator[Thing]:
    for _ in range(room.rng.integers(1, 3)):
        place, z = room.place(0.7, 1.6)
        hue = room.rng.uniform(0, 1, 3) ** 2
        r, g, b = (hue / hue.max()).tolist()
        yield _lamp(room, place, z, (r, g, b))


def _diver(room: _Room) -> Iterator[Thing]:
    """Two white lights side by side, alike."""
    place, z = room.place(0.7, 1.6)
    first = _lamp(room, place, z, (1.0, 0.95, 0.85))
    yield first
    beside = place + z * np.array([room.rng.uniform(0.05, 0.2), room.rng.uniform(-0.05, 0.05), 0])
    x, y, z = room.in_dock(beside)
    yield Thing("lamp", (x, y, z), first.size_m, first.colour, radiance=first.radiance)


def _own_colour(room: _Room) -> Iterator[Thing]:
    """Things painted in the markers' colour, or lamps of it."""
    for _ in range(room.rng.integers(1, 4)):
        place, z = room.place(0.9, 1.6)
        if room.rng.uniform() < 0.4:
            yield _lamp(room, place, z, (1.0, 1.0, 1.0), own=True)
        else:
            size = room.size(z, 0.003, 0.03)
            yield Thing("disc", room.in_dock(place), size, (0.6, 0.6, 0.6), own_colour=True)


def _other_dock(room: _Room) -> Iterator[Thing]:
    """Three to six lamps on an arc, alike."""
    place, z = room.place(1.0, 1.6)
    count, colour = int(room.rng.integers(3, 7)), _colour(room.rng)
    peak = max(colour)
    r, g, b = (c / peak for c in colour)
    radius, start = z * room.rng.uniform(0.05, 0.2), room.rng.uniform(0, 2 * np.pi)
    first = _lamp(room, place, z, (r, g, b))
    for angle in start + np.arange(count) * np.pi / 4:
        at = place + radius * np.array([np.cos(angle), np.sin(angle), 0.0])
        x, y, away = room.in_dock(at)
        yield Thing("lamp", (x, y, away), first.size_m, first.colour, radiance=first.radiance)


_MAKERS: dict[str, Callable[[_Room], Iterator[Thing]]] = {
    "buoys": _buoys,
    "posts": _posts,
    "boxes": _boxes,
    "single_lamp": _single_lamp,
    "diver": _diver,
    "own_colour": _own_colour,
    "other_dock": _other_dock,
}
