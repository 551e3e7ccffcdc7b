"""Looks for the dock in the pictures of a topic."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from chromadock.camera import CameraModel
from chromadock.errors import ChromadockError
from chromadock.results.detection import Detection
from chromadock.ros.header import CAMERA_FRAME, FrameIds, stamp_ns_of
from chromadock.ros_node.calibration import Description, described_camera, description_of
from chromadock.ros_node.imu import Attitudes
from chromadock.ros_node.parameters import NodeSettings
from chromadock.sources.ros_pictures import picture
from chromadock.track.tracker import RESTART_S
from chromadock.vehicle.building import camera_of, detector_of, dock_of


@dataclass(frozen=True, slots=True)
class TopicNames:
    """What messages call the topics: as they are after remapping."""

    image: str
    camera_info: str


@dataclass(frozen=True, slots=True)
class Seen:
    """What came of a picture: ``stamp_ns``, Unix nanoseconds, and the frame ids that its messages
    have; and a result, or a complaint in one line why there is none."""

    stamp_ns: int
    ids: FrameIds
    detection: Detection | None = None
    complaint: str | None = None


class Finder:
    """Messages in, results out.

    The camera is that of the newest CameraInfo: cameras that tell theirs only once, or by other
    stamps than the pictures', will do.  Where it changes, the track starts anew.

    Parameters
    ----------
    settings
        A file in ``camera.calibration`` takes precedence over any CameraInfo.
    topics
        For messages.
    tell
        Takes one line about what was assumed, once each.

    Raises
    ------
    ChromadockError
        Where a file is none, or the dock cannot be looked for as it is set.
    """

    def __init__(
        self, settings: NodeSettings, topics: TopicNames, tell: Callable[[str], None]
    ) -> None:
        self._settings = settings
        self._topics = topics
        self._tell = tell
        self._told: set[str] = set()
        self._dock = dock_of(settings.vehicle)
        camera = camera_of(settings.vehicle)
        # Without a camera yet, to refuse at the start what cannot be looked for.
        self._detector = detector_of(settings.vehicle, camera, self._dock)
        self._camera = camera
        self._described: Description | None = None
        self._fault: str | None = None
        if camera is None:
            self._fault = (
                f"no CameraInfo on {topics.camera_info} yet: remap camera_info to the camera's, or "
                "set the parameter camera.calibration"
            )
        self._attitudes = Attitudes()
        self._start_ns: int | None = None
        self._newest_ns = 0

    def camera_info(self, message: Any) -> None:
        """Take in a ``sensor_msgs/CameraInfo``; a wrong one stops the results.

        One comes with each picture, and seldom says anything new.
        """
        description = description_of(message)
        if description == self._described:
            return
        self._described = description
        try:
            camera = described_camera(description, self._topics.camera_info)
        except ChromadockError as error:
            self._camera, self._fault = None, str(error)
            return
        if self._camera is None or camera.key != self._camera.key:
            self._set(camera)
        self._fault = None

    def orientation(self, message: Any) -> None:
        """Take in a ``sensor_msgs/Imu``."""
        self._attitudes.heard(message)

    def picture(self, message: Any, now_ns: int) -> Seen:
        """Look for the dock in a ``sensor_msgs/Image`` or ``CompressedImage``.

        Parameters
        ----------
        now_ns : this moment by ROS's clock, for pictures that nobody has put a stamp on.
        """
        stamp_ns = stamp_ns_of(message)
        if not stamp_ns:
            self._once(f"{self._topics.image}: no stamps: the time of arrival is taken for them")
            stamp_ns = now_ns
        ids = FrameIds(self._camera_frame(message), self._settings.node.dock_frame)
        if self._fault is not None:
            return Seen(stamp_ns, ids, complaint=self._fault)
        try:
            image = picture(message, self._topics.image)
            time_s = self._time_s(stamp_ns)
            detection = self._detector.process(image, time_s, self._attitudes.at(stamp_ns))
        except ChromadockError as error:
            return Seen(stamp_ns, ids, complaint=str(error))
        return Seen(stamp_ns, ids, detection)

    def _set(self, camera: CameraModel) -> None:
        self._camera = camera
        self._detector = detector_of(self._settings.vehicle, camera, self._dock)

    def _time_s(self, stamp_ns: int) -> float:
        """Seconds from the first picture; where stamps go back the track starts anew."""
        if self._start_ns is None:
            self._start_ns = stamp_ns
        if stamp_ns < self._newest_ns - round(RESTART_S * 1e9):
            self._tell(f"{self._topics.image}: stamps went back: the track starts anew")
            self._newest_ns = stamp_ns
        self._newest_ns = max(self._newest_ns, stamp_ns)
        return (stamp_ns - self._start_ns) / 1e9

    def _camera_frame(self, message: Any) -> str:
        chosen: str = self._settings.node.camera_frame or message.header.frame_id
        if not chosen:
            self._once(f"{self._topics.image}: no frame_id: {CAMERA_FRAME} is taken for it")
        return chosen or CAMERA_FRAME

    def _once(self, line: str) -> None:
        if line not in self._told:
            self._told.add(line)
            self._tell(line)
