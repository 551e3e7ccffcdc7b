"""What a worker does: simulate a run's course, then render and measure a chunk of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2

from chromadock.colour.hsv import degrees
from chromadock.evaluate.finders import Finders
from chromadock.evaluate.measure import hue_difference_deg, measured
from chromadock.evaluate.picture import frame_jpeg, mask_png, swatches_json
from chromadock.evaluate.plan import Chunk, run_digest
from chromadock.evaluate.runs import Run
from chromadock.evaluate.target import target_of
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.view import Vehicle, View
from chromadock.sim.photograph import Photographs
from chromadock.sim.simulation import Simulation, Step

Row = dict[str, Any]
Measured = tuple[list[Row], dict[str, bytes]]
"""Rows of frames and filters, and files for the gallery by name."""


def simulated_steps(run: Run) -> list[Step]:
    """All steps of a run: the dock's decisions and both cameras' settings, one after the other.

    Quick beside the vehicle's frames, which any worker may then render in any order.
    """
    cv2.setNumThreads(1)
    return list(_simulation(run).steps(run.time_s(frame) for frame in range(run.frames)))


def measured_chunk(chunk: Chunk, steps: Sequence[Step], tuned: Tuned) -> Measured:
    """The rows of a chunk, by frame and then by filter, and the files of its sample frame.

    ``steps`` are all of the run.  The frames of the warm-up only move the rolling mean, so
    that it is that of an unbroken run.
    """
    cv2.setNumThreads(1)
    run, simulation = chunk.run, _simulation(chunk.run)
    scene, vehicle = run.scene, Vehicle()
    finders = Finders(scene.dock, scene.vehicle_camera.model, tuned, scene.mounting)
    for step in steps[chunk.warm_up : chunk.first]:
        vehicle.decide(simulation.frame(step).image_bgr, step.time_s)
    rows: list[Row] = []
    files: dict[str, bytes] = {}
    for step in steps[chunk.first : chunk.end]:
        frame = simulation.frame(step)
        view = vehicle.view(frame.image_bgr, step.time_s)
        target = target_of(scene, frame.truth)
        shared = _shared(run, step, view)
        in_view = all(marker.in_view for marker in frame.truth.markers)
        for name in run.filters:
            found, mask = finders.find(name, view, run.mapping)
            what = measured(found, mask, target)
            rows.append({**shared, "filter": name, **what, "markers_in_view": in_view})
            if step.index == chunk.sample:
                files[f"{run.name}.{name}.png"] = mask_png(view.frame_bgr, mask, found.blobs)
        if step.index == chunk.sample:
            files[f"{run.name}.jpg"] = frame_jpeg(view.frame_bgr)
            files[f"{run.name}.json"] = _swatches(run, step, view)
    return rows, files


def _shared(run: Run, step: Step, view: View) -> Row:
    """What the rows of one frame have in common."""
    vehicle_hue_deg = degrees(view.marker_hues[run.mapping])
    apart_deg = hue_difference_deg(step.dock_hue_deg, vehicle_hue_deg)
    row: Row = {
        "experiment": run.experiment,
        "run": run.name,
        "water": run.scene.name,
        "mapping": run.mapping,
        "distance_m": run.distance_m,
        "heading": run.heading,
        "frame": step.index,
        "time_s": step.time_s,
        "dock_hue_deg": step.dock_hue_deg,
        "vehicle_hue_deg": vehicle_hue_deg,
        # Lamps that do not follow the water show neither of the two.
        "hue_disagreement_deg": apart_deg if run.scene.dock.colour is None else None,
    }
    for side, rgb in (("", view.background.rgb), ("dock_", step.dock_background)):
        row |= {f"{side}background_{c}": v for c, v in zip("rgb", rgb, strict=True)}
    return row


def _swatches(run: Run, step: Step, view: View) -> bytes:
    return swatches_json(
        {
            "vehicle": (view.background.rgb, degrees(view.marker_hues[run.mapping])),
            "dock": (step.dock_background, step.dock_hue_deg),
        }
    )


# A simulation takes a while to build; chunks of a run mostly come one after the other.
_recent: dict[str, Simulation] = {}
_RECENT = 2


def _simulation(run: Run) -> Simulation:
    key = run_digest(run)
    if key not in _recent:
        while len(_recent) >= _RECENT:
            del _recent[next(iter(_recent))]
        photographs = None if run.photographs is None else Photographs(run.photographs)
        _recent[key] = Simulation(run.scene, run.mapping, photographs)
    return _recent[key]
