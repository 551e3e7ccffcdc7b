"""An experiment of two short runs of small pictures, and static filters that need no tuning."""

from __future__ import annotations

import json
from pathlib import Path

from chromadock.evaluate.experiment import read_experiment
from chromadock.evaluate.runs import Run, runs_of
from chromadock.evaluate.tuned import Box, Tuned
from chromadock.evaluate.tuning_frames import tuning_digest

TUNED = Tuned(
    {"pool": Box((140, 60, 60), (175, 255, 255)), "lake": Box((100, 60, 60), (140, 255, 255))},
    200,
    {},
)

CONTENT = """
name = "quay"
scene = "pool"
frames = 26
rate_hz = 4.0
seed = 7
mappings = ["ternary"]
filters = ["adaptive ternary", "static lake"]

# Small pictures of little: quick.
[set]
"vehicle.distance_m" = 1.5
"light.diffuse_share" = 0.2
"vehicle_camera.model" = "ov2640"
"dock.frame" = false
"body" = []
"particles.concentration_per_m3" = 0
"light.cloud" = [{ start_s = 1, fade_s = 4, transmittance = 0.3 }]

[vary]
"vehicle_camera.white_balance" = ["daylight", "auto"]
"""


def write(folder: Path, content: str = CONTENT) -> Path:
    """The experiment's file."""
    path = folder / "quay.toml"
    path.write_text(content)
    return path


def runs(folder: Path, content: str = CONTENT) -> list[Run]:
    path = write(folder, content)
    return runs_of(read_experiment(path), path)


def leave_tuned(out: Path) -> None:
    """What an earlier evaluation by this code would have left in ``out``: tuning takes a while."""
    out.mkdir(exist_ok=True)
    content = {"digest": tuning_digest(), **TUNED.to_dict()}
    (out / "tuned.json").write_text(json.dumps(content))
