"""Chromadock for the vehicle: find the dock by the colour that its LEDs must have.

from chromadock import CameraModel, Detector, DockGeometry

detector = Detector(CameraModel.from_yaml("cam.yaml"), DockGeometry.default())
detection = detector.process(frame_bgr, time_s)
"""

from chromadock.camera import CameraModel
from chromadock.detection import Detection
from chromadock.detector import Detector
from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError
from chromadock.mounting import Mounting
from chromadock.track.attitude import Attitude
from chromadock.track.result import Track
from chromadock.track.tracker import Tracker

__all__ = [
    "Attitude",
    "CameraModel",
    "ChromadockError",
    "Detection",
    "Detector",
    "DockGeometry",
    "Mounting",
    "Track",
    "Tracker",
]
