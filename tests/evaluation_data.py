"""A small made-up evaluation: frames.parquet and gallery as `chromadock evaluate` leaves them."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import polars as pl

FILTERS = {
    "robust": (2e-4, 2e-4, 8.0),
    # Medians of the share of pixels passed: (lake, pool), and how far one recalls markers.
    "adaptive ternary": (3e-4, 4e-4, 6.0),
    "adaptive complement": (6e-3, 2e-3, 4.0),
    "static pool": (5e-2, 3e-4, 4.5),
    "static lake": (2e-4, 3e-2, 3.0),
    "intensity": (2e-2, 4e-2, 2.0),
}
PROVENANCE = {
    "experiments": {
        name: {"seed": 7, "digest": "0123456789abcdef"}
        for name in (
            *("lake", "pool", "photographs", "rendered water"),
            *("tint", "balance", "hues", "conditions"),
        )
    },
    "versions": {"chromadock": "0.1.0", "jerlov": "0.22.0"},
}
TUNED = {
    "boxes": {
        "pool": {"low": [119, 20, 127], "high": [214, 65, 255]},
        "lake": {"low": [45, 35, 139], "high": [87, 64, 235]},
    },
    "grey": 154,
    "evidence": {"pool": {"f1": 0.65}, "lake": {"f1": 0.33}, "grey": {"f1": 0.05}},
}
PIXELS = 640 * 480
SEED = 4


def write_evaluation(out: Path, frames: int = 24) -> pl.DataFrame:
    """Write both below ``out``; ``frames`` a run."""
    rng = np.random.default_rng(SEED)
    rows = [row for run in runs() for row in run_rows(run, frames, rng)]
    table = pl.DataFrame(rows, infer_schema_length=None)
    out.mkdir(parents=True, exist_ok=True)
    table.write_parquet(out / "frames.parquet")
    (out / "evaluation.json").write_text(json.dumps(PROVENANCE))
    (out / "tuned.json").write_text(json.dumps(TUNED))
    write_gallery(out / "gallery", [run for run in runs() if not run["vary"]], rng)
    return table


def runs() -> Iterator[dict[str, Any]]:
    """The paper's runs, one with photographs, two sweeps and a study of mappings."""
    for distance, heading in itertools.product((1.0, 3.0, 5.0), "NESW"):
        name = f"lake {distance:g} m {heading}"
        yield run_of("lake", name, "lake", "ternary", distance, heading)
    for mapping, distance in itertools.product(("ternary", "complement"), (1.0, 3.0, 5.0)):
        name = f"pool {distance:g} m {mapping}"
        yield run_of("pool", name, "pool", mapping, distance)
    for experiment, distance in itertools.product(("photographs", "rendered water"), (1.0, 3.0)):
        name = f"{experiment} {distance:g} m"
        yield run_of(experiment, name, "pool", "ternary", distance)
    for tint in (0.7, 0.85, 1.0, 1.15, 1.3):
        vary = {"vehicle_camera.tint": tint}
        yield run_of("tint", f"tint {tint}", "pool", "ternary", 3.0, vary=vary)
    for dock, vehicle in itertools.product(("locked", "auto"), repeat=2):
        vary = {"dock_camera.white_balance": dock, "vehicle_camera.white_balance": vehicle}
        yield run_of("balance", f"balance {dock} {vehicle}", "pool", "ternary", 3.0, vary=vary)

    for condition, water, distance in itertools.product(CONDITIONS, ("quay", "pond"), (2.0, 4.0)):
        name = f"conditions {distance:g} m {condition} {water}"
        vary = {"condition": condition, "body of water": water}
        yield run_of("conditions", name, "pool", "ternary", distance, vary=vary)
    for water, mapping, distance in itertools.product(
        ("brown", "green"), ("ternary", "complement", "contrast"), (3.0, 7.0)
    ):
        name = f"hues {distance:g} m {mapping} {water}"
        yield run_of("hues", name, "lake", mapping, distance, vary={"body of water": water})


def run_of(
    experiment: str,
    run: str,
    water: str,
    mapping: str,
    distance_m: float,
    heading: str | None = None,
    vary: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """What all frames of a run share."""
    return {
        "experiment": experiment,
        "run": run,
        "water": water,
        "mapping": mapping,
        "distance_m": distance_m,
        "heading": heading,
        "vary": vary or {},
    }


VARIED = (
    "vehicle_camera.tint",
    "dock_camera.white_balance",
    "vehicle_camera.white_balance",
    "body of water",
    "condition",
)
CONDITIONS = ("noon", "night", "white lamps")
"""At noon the dock is found always; at night never at 4 m, where every other pose is wrong; white
lamps have no hue."""
CONTRAST_FINDS = {"brown": 1.0, "green": 0.0}
"""Share of the frames, at any distance."""


def run_rows(
    run: dict[str, Any], frames: int, rng: np.random.Generator
) -> Iterator[dict[str, Any]]:
    """One row a frame and filter."""
    shared = {key: value for key, value in run.items() if key != "vary"}
    varied = {key: run["vary"].get(key) for key in VARIED}
    offset = 120 * abs((varied["vehicle_camera.tint"] or 1.0) - 1.0)
    offset += 40 * sum(value == "auto" for value in run["vary"].values())
    for frame in range(frames):
        disagreement = abs(rng.normal(offset, 3))
        dock_hue = 320.0 if run["water"] == "pool" else 235.0
        for name in FILTERS:
            yield {
                **shared,
                **varied,
                "frame": frame,
                "time_s": frame / 5,
                "filter": name,
                **measures(run, name, disagreement, rng),
                **condition_measures(run, frame),
                "dock_hue_deg": dock_hue,
                "vehicle_hue_deg": (dock_hue + disagreement) % 360,
                "hue_disagreement_deg": None
                if varied["condition"] == "white lamps"
                else disagreement,
                "background_r": 40,
                "background_g": 150,
                "background_b": 190,
                "dock_background_r": 50,
                "dock_background_g": 155,
                "dock_background_b": 185,
                "markers_in_view": bool(frame % 12),
            }


def condition_measures(run: dict[str, Any], frame: int) -> dict[str, Any]:
    """What replaces a filter's measures in the runs of ``CONDITIONS``."""
    if run["experiment"] != "conditions":
        return {}
    lost = run["vary"]["condition"] == "night" and run["distance_m"] == 4
    return {"correct": not lost, "wrong_pose": lost and frame % 2 == 0}


def measures(
    run: dict[str, Any], name: str, disagreement: float, rng: np.random.Generator
) -> dict[str, Any]:
    """What one filter made of one frame."""
    lake, pool, reach_m = FILTERS[name]
    passed = (lake if run["water"] == "lake" else pool) * rng.lognormal(0, 0.6)
    passed = round(passed * PIXELS * (0 if rng.random() < 0.02 else 1)) / PIXELS
    reach_m *= 0.5 if run["water"] == "lake" else 1.0
    chance = 1 / (1 + np.exp(2 * (run["distance_m"] - reach_m) + (disagreement - 30) / 8))
    if run["mapping"] == "contrast":
        chance = CONTRAST_FINDS[run["vary"]["body of water"]]
    correct = bool(rng.random() < chance)
    false = not correct and bool(rng.random() < 0.1)
    distance = run["distance_m"]

    def error(size: float) -> float | None:
        return float(rng.normal(0, size)) if correct else None

    return {
        "passed": passed,
        "passed_outside": round(passed * 0.4 * PIXELS) / PIXELS,
        "found": correct or false,
        "correct": correct,
        "false_dock": false,
        "wrong_pose": false,
        "range_true_m": distance,
        "range_error": error(0.01 * distance),
        "bearing_error_deg": error(0.05),
        "attitude_error_deg": error(1.5 * distance),
    }


def write_gallery(folder: Path, shown: list[dict[str, Any]], rng: np.random.Generator) -> None:
    """A frame, a mask for each filter and the swatches of every run."""
    folder.mkdir(exist_ok=True)
    for run in shown:
        name, lake = run["run"], run["water"] == "lake"
        marker = (60, 60, 255) if lake else (255, 0, 170)
        water = np.array([60, 140, 70] if lake else [190, 150, 40], np.float64)
        light = np.linspace(1.2, 0.8, 120)[:, None, None] * water
        picture = np.clip(light + rng.normal(0, 3, (120, 160, 3)), 0, 255).astype(np.uint8)
        masks = {filter_: np.zeros_like(picture) for filter_ in FILTERS}
        for x, y in itertools.product((50, 110), (50, 59)):
            cv2.circle(picture, (x, y), 2, marker[::-1], -1, cv2.LINE_AA)
            for mask in masks.values():
                cv2.circle(mask, (x, y), 2, marker[::-1], -1)
                cv2.circle(mask, (x, y), 4, (0, 200, 0))
        for filter_, mask in masks.items():
            noise = rng.random(mask.shape[:2]) < FILTERS[filter_][0 if lake else 1]
            mask[noise] = picture[noise]
            cv2.imwrite(str(folder / f"{name}.{filter_}.png"), mask)
        cv2.imwrite(str(folder / f"{name}.jpg"), picture)
        side = {"background": [40, 150, 190], "pure": [0, 200, 255], "marker": marker}
        swatches = {"vehicle": side, "dock": {**side, "background": [60, 140, 180]}}
        (folder / f"{name}.json").write_text(json.dumps(swatches))


def rows_of(frames: pl.DataFrame, **wanted: object) -> list[dict[str, object]]:
    """The rows by plain Python, the other way to each figure."""
    return [row for row in frames.to_dicts() if all(row[k] == v for k, v in wanted.items())]
