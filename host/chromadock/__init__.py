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

__all__ = ["CameraModel", "ChromadockError", "Detection", "Detector", "DockGeometry"]
