"""All that the doctor looks at, one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from chromadock.camera import CameraModel
from chromadock.doctor.autopilot import heartbeats
from chromadock.doctor.camera import calibration, camera
from chromadock.doctor.computer import clock, disk, load
from chromadock.doctor.finding import Finding
from chromadock.doctor.ports import dock, serial_ports
from chromadock.errors import ChromadockError
from chromadock.output.addresses import check_output
from chromadock.vehicle.building import (
    camera_of,
    camera_settings_of,
    detector_of,
    dock_of,
    outputs_of,
)
from chromadock.vehicle.keys import VehicleFile

DOCK_S = 2.0
"""For a dock to answer."""


def examined(vehicle: VehicleFile, dock_port: str | None, look_for_dock: bool) -> Iterator[Finding]:
    """Every finding, as soon as it is made.

    Parameters
    ----------
    vehicle : the settings that the vehicle will run by.
    dock_port : of the dock's serial line; None for the only one that there is.
    look_for_dock : whether to ask a dock at all: under water it is not on a line.
    """
    yield from (clock(), disk(Path.cwd()), load())
    model: CameraModel | None = None
    try:
        model = camera_of(vehicle)
        yield calibration(model)
        detector_of(vehicle, model, dock_of(vehicle))
        for text in outputs_of(vehicle):
            check_output(text)
        yield Finding("ok", "settings", "dock, colours and outputs are well")
    except ChromadockError as error:
        yield Finding("fault", "settings", str(error))
    yield from camera(vehicle.camera.source, model, camera_settings_of(vehicle))
    yield from serial_ports()
    if look_for_dock:
        yield dock(dock_port, DOCK_S)
    yield from heartbeats()
