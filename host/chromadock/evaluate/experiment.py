"""Experiments as data: what is run, in which water, and what is varied.

    name = "lake"
    scene = "lake"              # shipped with chromadock.sim, or a file, from this one's folder
    frames = 500                # a run
    rate_hz = 4.1667
    seed = 1
    mappings = ["ternary"]
    filters = ["robust", "adaptive ternary"]  # all of them if left out
    photographs = "../photos"   # folder, in the place of rendered water; may be left out

    [set]                       # keys of the scene, for all runs
    "vehicle.heading_deg" = 90

    [vary]                      # every combination is a run
    "vehicle.distance_m" = [1, 3, 5]
    light = [                   # keys of the scene that vary together, under a label
        { label = "noon", "ambient.surface_illuminance_lux" = 100000 },
        { label = "night", "ambient.surface_illuminance_lux" = 0 },
    ]

All runs have the same seed, so that waves and noise are no difference between them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationError, field_validator

from chromadock.choices import MAPPINGS
from chromadock.evaluate.filters import FILTERS
from chromadock.toml_file import one_line_error, read_toml
from chromadock.validation import allowed, between

LABEL = "label"

MAX_FRAMES = 100_000
MAX_SEED = 990_000


class Experiment(BaseModel):
    """An experiment file's content."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    _folder: Path = PrivateAttr(default=Path())
    name: Annotated[
        str,
        Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]*$"),
        allowed('letters, digits, blanks and _ . - such as "lake"'),
    ]
    scene: Annotated[str, Field(min_length=1), allowed("the name of a scene or its TOML file")]
    frames: Annotated[int, between(1, MAX_FRAMES, "whole frames a run")]
    rate_hz: Annotated[float, between(0.01, 120, "frames a second")]
    seed: Annotated[int, between(0, MAX_SEED)]
    mappings: Annotated[tuple[str, ...], Field(min_length=1)]
    filters: Annotated[tuple[str, ...], Field(min_length=1)] = FILTERS
    photographs: Annotated[str, Field(min_length=1), allowed("a folder's name")] | None = None
    set: dict[str, Any] = {}
    vary: dict[str, Annotated[list[Any], Field(min_length=1)]] = {}

    @field_validator("mappings", "filters", mode="before")
    @classmethod
    def _tuple(cls, value: Any) -> Any:
        return tuple(value) if isinstance(value, list) else value

    @field_validator("mappings")
    @classmethod
    def _known_mappings(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        return _known("mapping", names, MAPPINGS)

    @field_validator("filters")
    @classmethod
    def _known_filters(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        return _known("filter", names, FILTERS)

    @field_validator("vary")
    @classmethod
    def _labelled(cls, vary: dict[str, list[Any]]) -> dict[str, list[Any]]:
        for key, values in vary.items():
            labels = [str(v.get(LABEL) if isinstance(v, dict) else v) for v in values]
            tables = [v for v in values if isinstance(v, dict)]
            if any(not isinstance(v.get(LABEL), (str, int, float)) or len(v) < 2 for v in tables):
                raise ValueError(f"{key}: each table needs a {LABEL} and keys of the scene")
            if tables and len(tables) < len(values):
                raise ValueError(f"{key}: give values or tables, not both")
            if len(set(labels)) < len(labels):
                raise ValueError(f"{key}: a value stands there twice")
        return vary

    @property
    def photograph_folder(self) -> Path | None:
        """The folder of ``photographs``, from the experiment's own folder."""
        return None if self.photographs is None else self._folder / self.photographs

    @property
    def scene_source(self) -> str:
        """What ``load_scene`` takes: a name, or the file from the experiment's own folder."""
        is_file = self.scene.endswith(".toml")
        return str(self._folder / self.scene) if is_file else self.scene


def read_experiment(path: Path) -> Experiment:
    """The experiment in a TOML file; its scene is not looked at yet.

    Raises
    ------
    ChromadockError
        One line with the file, the key, what is wrong and what is allowed.
    """
    content = read_toml(path, "give an experiment such as experiments/pool.toml")
    try:
        experiment = Experiment.model_validate(content)
    except ValidationError as error:
        raise one_line_error(path, error) from None
    experiment._folder = path.parent
    return experiment


def _known(what: str, names: tuple[str, ...], known: tuple[str, ...]) -> tuple[str, ...]:
    for name in names:
        if name not in known:
            raise ValueError(f'unknown {what} "{name}": choose from {", ".join(known)}')
        if names.count(name) > 1:
            raise ValueError(f"{name} stands there twice")
    return names
