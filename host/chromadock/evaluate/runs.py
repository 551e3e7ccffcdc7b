"""The runs of an experiment: every combination of what it varies."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from chromadock.errors import ChromadockError
from chromadock.evaluate.experiment import LABEL, Experiment, read_experiment
from chromadock.sim.scene import Scene, load_scene

DISTANCE = "vehicle.distance_m"
HEADING = "vehicle.heading_deg"

_WINDS: Mapping[float, str] = {0.0: "N", 90.0: "E", 180.0: "S", 270.0: "W"}

Setting = str | float | bool


@dataclass(frozen=True, eq=False)
class Run:
    """Dock and vehicle in one scene for a while.

    Parameters
    ----------
    experiment, name
        The experiment's, and what tells this run from its others.
    scene
        With everything set that the run sets.
    mapping
        One of ``MAPPINGS``: what the dock shows.
    filters
        Some of ``FILTERS``.
    frames, rate_hz
        How many frames at how many a second, from time 0.
    photographs
        Folder of what is behind the dock; None for the scene's own water.
    heading
        Where the vehicle looks, as N, E, S, W or degrees; None where the experiment does
        not vary it.
    varied
        What the experiment varies, by key or label.
    """

    experiment: str
    name: str
    scene: Scene
    mapping: str
    filters: tuple[str, ...]
    frames: int
    rate_hz: float
    photographs: Path | None
    heading: str | None
    varied: Mapping[str, Setting]

    @property
    def distance_m(self) -> float:
        """From the vehicle's camera to the dock, at rest and at first."""
        return self.scene.motion.course.from_m

    def time_s(self, frame: int) -> float:
        """When a frame is taken."""
        return frame / self.rate_hz


def runs_of(experiment: Experiment, path: Path, frames: int | None = None) -> list[Run]:
    """The runs in the order of the file, the last key varying fastest.

    Parameters
    ----------
    path : the experiment's file, for messages.
    frames : at most so many a run.

    Raises
    ------
    ChromadockError
        One line: what is wrong with the scene or with what is set in it.
    """
    count = experiment.frames if frames is None else min(frames, experiment.frames)
    return [
        _run(experiment, path, count, mapping, dict(varied))
        for varied in _combinations(experiment)
        for mapping in experiment.mappings
    ]


def _combinations(experiment: Experiment) -> Iterator[tuple[tuple[str, Any], ...]]:
    axes = [[(key, value) for value in values] for key, values in experiment.vary.items()]
    return itertools.product(*axes)


def _run(
    experiment: Experiment, path: Path, frames: int, mapping: str, varied: dict[str, Any]
) -> Run:
    overrides = {**experiment.set, "seed": experiment.seed}
    settings: dict[str, Setting] = {}
    for key, value in varied.items():
        if isinstance(value, dict):
            overrides |= {k: v for k, v in value.items() if k != LABEL}
            settings[key] = value[LABEL]
        else:
            overrides[key] = value
            settings[key] = value if isinstance(value, (str, int, float)) else str(value)
    try:
        scene = load_scene(experiment.scene_source, overrides)
    except ChromadockError as error:
        raise ChromadockError(f"{path}: {error}") from None
    heading = _wind(scene.motion.heading_deg) if HEADING in varied else None
    return Run(
        experiment=experiment.name,
        name=_name(experiment, scene.motion.course.from_m, heading, mapping, settings),
        scene=scene,
        mapping=mapping,
        filters=experiment.filters,
        frames=frames,
        rate_hz=experiment.rate_hz,
        photographs=experiment.photograph_folder,
        heading=heading,
        varied=settings,
    )


def _wind(heading_deg: float) -> str:
    return _WINDS.get(round(heading_deg % 360, 3), f"{heading_deg:g}")


def _name(
    experiment: Experiment,
    distance_m: float,
    heading: str | None,
    mapping: str,
    settings: Mapping[str, Setting],
) -> str:
    """Such as ``lake 3 m N``, ``pool 1 m complement``, ``cloud 3 m transmittance 0.2``."""
    parts = [experiment.name, f"{distance_m:g} m"]
    if heading is not None:
        parts.append(heading)
    if len(experiment.mappings) > 1:
        parts.append(mapping)
    parts += [
        f"{key.rpartition('.')[2]} {_short(value)}"
        for key, value in settings.items()
        if key not in (DISTANCE, HEADING)
    ]
    return " ".join(parts).replace("/", "-")


def _short(value: Setting) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def runs_of_files(
    paths: Sequence[Path], frames: int | None, tell: Callable[[str], None]
) -> list[Run]:
    """The runs of several experiment files; ``frames`` as for ``runs_of``.

    An experiment whose photographs are not there is left out, and a line says so to ``tell``.

    Raises
    ------
    ChromadockError
        One line: what is wrong with a file, or that two experiments have the same name.
    """
    runs: list[Run] = []
    read: dict[str, Path] = {}
    for path in paths:
        experiment = read_experiment(path)
        if experiment.name in read:
            raise ChromadockError(
                f'{path}: its name "{experiment.name}" is that of {read[experiment.name]}: '
                "give each experiment its own"
            )
        read[experiment.name] = path
        folder = experiment.photograph_folder
        if folder is not None and not folder.is_dir():
            tell(f"{path}: left out: no photographs in {folder}")
            continue
        runs += runs_of(experiment, path, frames)
    return runs
