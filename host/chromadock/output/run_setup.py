"""What a run was set to, for those who want to run it again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import metadata, resources
from pathlib import Path

from chromadock.camera import CameraModel
from chromadock.dock import DEFAULT_FILE
from chromadock.errors import ChromadockError
from chromadock.sources.address import without_secrets
from chromadock.vehicle.keys import VehicleFile

VEHICLE, CALIBRATION, DOCK = "vehicle.toml", "camera.yaml", "dock.toml"
"""Names of the files in a recording."""


@dataclass(frozen=True)
class RunSetup:
    """The settings that hold, and the camera made of them (None: a usual lens is assumed)."""

    settings: VehicleFile
    camera: CameraModel | None

    def vehicle(self) -> str:
        """The vehicle's file as it holds, but for passwords in the camera's address."""
        from chromadock.vehicle.manual import as_toml

        return as_toml(self._with_camera({}))

    def files(self) -> dict[str, bytes]:
        """By name: the vehicle's file as it holds, and those that it names, beside it.

        Passwords in a camera's address are left out: recordings are passed on.

        Raises
        ------
        ChromadockError
            Where a file that it names cannot be read any more.
        """
        from chromadock.vehicle.manual import as_toml

        keys = self.settings
        files = {DOCK: _content(keys.dock.file) if keys.dock.file else _shipped_dock()}
        if keys.camera.calibration:
            files[CALIBRATION] = _content(keys.camera.calibration)
        camera = self._with_camera({"calibration": CALIBRATION if CALIBRATION in files else ""})
        beside = camera.model_copy(update={"dock": keys.dock.model_copy(update={"file": DOCK})})
        return {VEHICLE: as_toml(beside).encode(), **files}

    def _with_camera(self, update: Mapping[str, str]) -> VehicleFile:
        """The settings without passwords in the camera's address, and with ``update`` of it."""
        camera = self.settings.camera
        public = {"source": without_secrets(camera.source), **update}
        return self.settings.model_copy(update={"camera": camera.model_copy(update=public)})


def chromadock_version() -> str:
    """Of the installed package; empty where it only lies there."""
    try:
        return metadata.version("chromadock")
    except metadata.PackageNotFoundError:
        return ""


def _content(path: str) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise ChromadockError(f"{path}: cannot be read ({error.strerror}): allow it") from None


def _shipped_dock() -> bytes:
    return (resources.files("chromadock") / DEFAULT_FILE).read_bytes()
