"""Chromadock for the vehicle: find the dock by the colour that its LEDs must have.

from chromadock import CameraModel, Detector, DockGeometry

detector = Detector(CameraModel.from_yaml("cam.yaml"), DockGeometry.default())
detection = detector.process(frame_bgr, time_s)
"""

from typing import TYPE_CHECKING

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

if TYPE_CHECKING:  # for type checkers and editors; Python itself goes by the function below
    from chromadock.camera import CameraModel
    from chromadock.detector import Detector
    from chromadock.dock import DockGeometry
    from chromadock.errors import ChromadockError
    from chromadock.mounting import Mounting
    from chromadock.results.detection import Detection
    from chromadock.results.track import Track
    from chromadock.track.attitude import Attitude
    from chromadock.track.tracker import Tracker
else:
    from importlib import import_module

    _HOMES = {
        "Attitude": "track.attitude",
        "CameraModel": "camera",
        "ChromadockError": "errors",
        "Detection": "results.detection",
        "Detector": "detector",
        "DockGeometry": "dock",
        "Mounting": "mounting",
        "Track": "results.track",
        "Tracker": "track.tracker",
    }

    def __getattr__(name):
        """Load a public name when it is first asked for.

        Python calls this for a name that the package does not have yet (PEP 562).  So a program
        waits for numpy and OpenCV only when it needs them, and `chromadock --help` never.
        """
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
        globals()[name] = value  # found without this function from now on
        return value

    def __dir__():
        """Tell editors and `dir()` also the names that are not loaded yet."""
        return sorted({*globals(), *__all__})
