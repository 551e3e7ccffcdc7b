"""From a vehicle's settings to what runs."""

from __future__ import annotations

import cv2
import numpy as np

from chromadock.camera import CameraModel
from chromadock.controls.features import FEATURES
from chromadock.controls.opening import CameraSettings
from chromadock.detector import Detector
from chromadock.dock import DockGeometry
from chromadock.marker_colour import MarkerColour
from chromadock.mounting import R_BODY_CAMERA_FORWARD, Mounting
from chromadock.vehicle.keys import MountingKeys, VehicleFile


def camera_of(vehicle: VehicleFile) -> CameraModel | None:
    """The calibrated camera; None for a usual lens.

    Raises
    ------
    ChromadockError
        Where its file is none.
    """
    calibration = vehicle.camera.calibration
    return CameraModel.from_yaml(calibration) if calibration else None


def camera_settings_of(vehicle: VehicleFile) -> CameraSettings:
    """What the camera is to be set to."""
    wishes = {feature.key: getattr(vehicle.camera, feature.key) for feature in FEATURES}
    return CameraSettings(
        {key: wish for key, wish in wishes.items() if wish != ""}, vehicle.camera.manager
    )


def dock_of(vehicle: VehicleFile, confirmed: bool = False) -> DockGeometry:
    """The dock's markers; ``confirmed``: see ``DockGeometry``.

    Raises
    ------
    ChromadockError
        Where its file is none.
    """
    file = vehicle.dock.file
    return DockGeometry.from_toml(file, confirmed) if file else DockGeometry.default()


def mounting_of(keys: MountingKeys | None) -> Mounting | None:
    """The camera's extrinsics; None where nobody has told them.

    The body's axes are forward, right and down: yaw turns about down, then pitch about right, then
    roll about forward (the order of aircraft, as in MAVLink's ATTITUDE).
    """
    if keys is None:
        return None
    turns = zip(np.eye(3)[::-1], (keys.yaw_deg, keys.pitch_deg, keys.roll_deg), strict=True)
    R = np.eye(3)
    for axis, angle_deg in turns:
        R = R @ cv2.Rodrigues(axis * np.radians(angle_deg))[0]
    return Mounting(R_body_camera=R @ R_BODY_CAMERA_FORWARD)


def outputs_of(vehicle: VehicleFile) -> list[str]:
    """Where the results go, as ``--out`` names it."""
    record = vehicle.outputs.record
    return [*vehicle.outputs.results, *([f"mcap:{record}"] if record else [])]


def detector_of(vehicle: VehicleFile, camera: CameraModel | None, dock: DockGeometry) -> Detector:
    """The detector.

    Raises
    ------
    ChromadockError
        Where a colour is none, or the method cannot find such a dock.
    """
    colour = vehicle.dock.colour
    return Detector(
        camera,
        dock,
        method=vehicle.detector.method,
        mapping=vehicle.dock.mapping,
        independent=vehicle.detector.independent,
        mounting=mounting_of(vehicle.mounting),
        marker_colour=MarkerColour.parse(colour, "dock.colour") if colour else None,
        fallback_hue_deg=vehicle.dock.fallback_hue_deg,
    )
