"""A recording of Chromadock: its settings and its results."""

from __future__ import annotations

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
from chromadock.replay.results import Results
from chromadock.ros.mcap_bag import head
from chromadock.ros.topics import start_of
from chromadock.sources.bag_kind import is_mcap
from chromadock.vehicle.building import camera_of, detector_of, dock_of
from chromadock.vehicle.keys import CameraKeys, VehicleFile
from chromadock.vehicle.reading import read_vehicle, settings_of

_OF_NO_USE = (
    "outputs.",
    *(f"camera.{key}" for key in CameraKeys.model_fields if key != "calibration"),
)
"""Beginnings of keys that change nothing where frames and their times are recorded ones."""


@dataclass(frozen=True)
class Recorded:
    """What a recording has beside its frames."""

    settings: VehicleFile
    camera: CameraModel | None
    detector: Detector
    results: Results


def read_recorded(path: Path, changes: Mapping[str, Any]) -> Recorded:
    """Settings, with ``changes`` by dotted key, and results of a recording.

    Raises
    ------
    ChromadockError
        Where it is none, or a change is none.
    """
    if not path.exists():
        raise ChromadockError(f"{path}: no such file: give a recording, as --record makes")
    files, metadata = head(path) if is_mcap(path) else ({}, {})
    start_ns = start_of(metadata)
    if VEHICLE not in files or start_ns is None:
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
    return Recorded(settings, camera, detector, Results(path, start_ns))


def check_changes(changes: Mapping[str, Any]) -> None:
    """Refuse what is no setting, or one that a replay has no use for.

    Raises
    ------
    ChromadockError
        One line with the key, or with the file that a change names.
    """
    for key in changes:
        if key.startswith(_OF_NO_USE):
            raise ChromadockError(f"--set {key}: changes nothing in a replay: leave it out")
    settings = settings_of(changes)
    camera_of(settings)
    dock_of(settings)


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
