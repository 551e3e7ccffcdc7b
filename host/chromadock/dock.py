"""Where the markers sit on the dock.

Dock frame: origin at the centre of the markers' rectangle, x right, y down, z away from
an approaching vehicle, as that vehicle sees it; metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from chromadock.dock_check import fault_of
from chromadock.errors import ChromadockError
from chromadock.geometry.symmetry import Symmetry, symmetries
from chromadock.marker_colour import WANTED, MarkerColour
from chromadock.toml_file import read_toml
from chromadock.validation import place, shown

DEFAULT_FILE = "default_dock.toml"
"""Packaged; it is also the example to copy."""


@dataclass(frozen=True, eq=False)
class DockGeometry:
    """Named markers of a dock.

    Parameters
    ----------
    names
        One name a marker, all different.
    points
        Nx3 float64, metres, dock frame, in the order of ``names``.
    source
        What messages call this dock: its file.
    colour
        Of lamps that shine in a colour of their own: ``#RRGGBB``, ``white`` or ``any``; None of
        a dock that chooses it by the water.
    largest_range_m
        From where the dock can be seen at most, to its markers' centroid; what is found farther
        away is none.  None for no such limit.
    confirmed
        That its user is sure of what is a slip in most files: markers more than 10 m apart, or seen
        edge-on by a vehicle that comes along z.

    Raises
    ------
    ChromadockError
        Fewer than three markers, a repeated name, a number that is not finite, markers
        that coincide or all lie on one line, that cannot be in metres, a colour that is none, a
        largest range that is not more than 0; unless ``confirmed``, what that is for.
    """

    names: tuple[str, ...]
    points: NDArray[np.float64]
    source: str = "dock"
    colour: str | None = None
    largest_range_m: float | None = None
    confirmed: bool = False

    def __post_init__(self) -> None:
        points = np.array(self.points, dtype=np.float64)
        points.setflags(write=False)
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "points", points)
        fault = fault_of(self.names, points, self.confirmed)
        if fault:
            raise ChromadockError(f"{self.source}: {fault}")
        if self.colour is not None:
            MarkerColour.parse(self.colour, f"{self.source}: colour")
        farthest = self.largest_range_m
        if farthest is not None and not (np.isfinite(farthest) and farthest > 0):
            raise ChromadockError(
                f"{self.source}: largest_range_m is {farthest:g}: give metres, more than 0"
            )

    @cached_property
    def centre(self) -> NDArray[np.float64]:
        """(3,) the markers' centroid, metres, dock frame: about it the pose is best known."""
        return np.asarray(self.points.mean(axis=0), np.float64)

    @cached_property
    def judged(self) -> NDArray[np.float64]:
        """(3,) metres, dock frame: the point by whose place a pose is judged right or wrong.

        The origin, since the place that is told is its own.  Where the user put that farther from
        the centroid than any marker, the point so far away in its direction: a docking point many
        metres off goes aside with each degree of the dock's attitude, and is no reason to withhold
        the pose of a dock that is well known itself.
        """
        away = float(np.linalg.norm(self.centre))
        reach = float(np.linalg.norm(self.points - self.centre, axis=1).max())
        return self.centre * (1 - min(1.0, reach / away)) if away > 0 else np.zeros(3)

    @cached_property
    def symmetries(self) -> tuple[Symmetry, ...]:
        """Turns after which the dock looks the same: see ``symmetry.symmetries``.

        Of the default rectangle the half turn about its normal: what excludes it is that the
        vehicle is upright.
        """
        return symmetries(self.points)

    @classmethod
    def default(cls) -> DockGeometry:
        """The original dock: a rectangle of 0.890 m x 0.127 m, named by its corners."""
        with resources.as_file(resources.files("chromadock") / DEFAULT_FILE) as path:
            return _loaded(path, DEFAULT_FILE, False)

    @classmethod
    def from_toml(cls, path: str | Path, confirmed: bool = False) -> DockGeometry:
        """The dock in a TOML file laid out like ``default_dock.toml``.

        ``confirmed``: see there; the same key of the file does as well.

        Raises
        ------
        ChromadockError
            One line with the file, what is wrong and the mend.
        """
        return _loaded(path, str(path), confirmed)


class _Marker(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)
    name: Annotated[str, Field(min_length=1)]
    position: Annotated[list[float], Field(min_length=3, max_length=3)]


class _DockFile(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)
    colour: str | None = None
    largest_range_m: float | None = None
    confirmed: bool = False
    marker: list[_Marker] = []


def _loaded(path: str | Path, source: str, confirmed: bool) -> DockGeometry:
    content = read_toml(path, "give a TOML file with one [[marker]] for each marker")
    try:
        file = _DockFile.model_validate(content)
    except ValidationError as error:
        raise ChromadockError(f"{source}: {_explain(error)}") from None
    points = np.array([m.position for m in file.marker], dtype=np.float64).reshape(-1, 3)
    names = tuple(m.name for m in file.marker)
    sure = confirmed or file.confirmed
    return DockGeometry(names, points, source, file.colour, file.largest_range_m, sure)


def _explain(error: ValidationError) -> str:
    """The first fault of a dock file in one line."""
    fault: Any = error.errors()[0]
    where, of_marker = place(fault["loc"][:3]), len(fault["loc"]) > 1
    if fault["type"] == "extra_forbidden":
        if of_marker and fault["loc"][-1] in ("colour", "largest_range_m", "confirmed"):
            return f"unknown key {where}: write it once, above the first [[marker]]"
        above = "colour, largest_range_m, confirmed and [[marker]]"
        known = "name and position" if of_marker else above
        return f"unknown key {where}: only {known} may stand there"
    if fault["type"] == "missing":
        return f"{where} is missing: each [[marker]] has a name and a position"
    if where == "colour":
        return f"colour is {shown(fault['input'])}: give {WANTED}"
    if where == "largest_range_m":
        return f"largest_range_m is {shown(fault['input'])}: give metres, such as 8.0"
    if where == "confirmed":
        return f"confirmed is {shown(fault['input'])}: give true or false"
    if "position" in fault["loc"]:
        return f"{where} must be three numbers in metres: position = [x, y, z]"
    if "name" in fault["loc"]:
        return f'{where} is {shown(fault["input"])}: write a text such as name = "top_left"'
    return f"{where} must be one or more [[marker]] with a name and a position"
