"""A recording of Chromadock: its settings and its results."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from chromadock.camera import CameraModel
from chromadock.detector import Detector
from chromadock.errors import ChromadockError
from chromadock.output.run_setup import VEHICLE
from chromadock.results.detection import Detection
from chromadock.ros.mcap_bag import McapBag, head
from chromadock.ros.topics import METADATA, RECORD, START
from chromadock.sources.bag_kind import is_mcap
from chromadock.vehicle.building import camera_of, detector_of, dock_of
from chromadock.vehicle.keys import VehicleFile
from chromadock.vehicle.reading import read_vehicle

_OF_NO_USE = ("outputs.", "camera.source", "camera.delay_s")
"""Beginnings of keys that change nothing where frames and their times are recorded ones."""


@dataclass(frozen=True)
class Recorded:
    """What a recording has beside its frames.

    ``results`` by the ``Frame.time_s`` of their frames, as ``sources`` reads these.
    """

    settings: VehicleFile
    camera: CameraModel | None
    detector: Detector
    results: dict[float, Detection]


def read_recorded(path: Path, changes: Mapping[str, Any]) -> Recorded:
    """Settings, with ``changes`` by dotted key, and results of a recording.

    Raises
    ------
    ChromadockError
        Where it is none, or a change is none.
    """
    for key in changes:
        if key.startswith(_OF_NO_USE):
            raise ChromadockError(f"--set {key}: changes nothing in a replay: leave it out")
    if not path.exists():
        raise ChromadockError(f"{path}: no such file: give a recording, as --record makes")
    files, metadata = head(path) if is_mcap(path) else ({}, {})
    if VEHICLE not in files or METADATA not in metadata:
        raise ChromadockError(
            f"{path}: not recorded by chromadock, so it has no settings and results to compare "
            "with: see what is in it with `chromadock detect`"
        )
    with _unpacked(path, files) as folder:
        settings = read_vehicle(folder / VEHICLE, changes)
        camera = camera_of(settings)
        # The recorded dock was looked at when it was recorded; another one was not.
        dock = dock_of(settings, confirmed="dock.file" not in changes)
        detector = detector_of(settings, camera, dock)
    return Recorded(settings, camera, detector, _results(path, int(metadata[METADATA][START])))


@contextmanager
def _unpacked(path: Path, files: Mapping[str, bytes]) -> Iterator[Path]:
    """The files as files; what is wrong in one is said of the recording."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name, content in files.items():
            (folder / Path(name).name).write_bytes(content)
        try:
            yield folder
        except ChromadockError as error:
            raise ChromadockError(str(error).replace(scratch, str(path))) from None


def _results(path: Path, start_ns: int) -> dict[float, Detection]:
    with McapBag(path) as bag:
        return {
            (logged_ns - start_ns) / 1e9: Detection.from_dict(json.loads(message.data))
            for logged_ns, message in bag.messages(RECORD)
        }
