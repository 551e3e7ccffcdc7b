"""Frames out of recordings: MCAP files and the bags of ROS 1 and ROS 2."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

from chromadock.choices import DEFAULT_FPS
from chromadock.errors import ChromadockError
from chromadock.ros.attitude import attitude_from_imu
from chromadock.ros.bags import Bag, Topic
from chromadock.ros.header import stamp_ns_of
from chromadock.ros.mcap_bag import McapBag, head
from chromadock.ros.ros_bag import RosBag
from chromadock.ros.topics import ATTITUDE, TOPICS, start_of
from chromadock.sources.bag_kind import is_mcap
from chromadock.sources.base import Frame, OnFault, Source
from chromadock.sources.ros_pictures import COMPRESSED, IMAGE, picture
from chromadock.text import one_line, plural
from chromadock.track.attitude import Attitude

_RATE_FRAMES = 10
"""So many stamps tell the frames a second."""


class BagFrames(Source):
    """The pictures of a topic, each at the time that its header says.

    Times count from the start of the run that Chromadock recorded, or from the first picture.
    Where headers have no stamp, when a message was logged counts.  Pictures that cannot be
    decoded are told, counted and left out.  A picture has the vehicle's attitude where Chromadock
    recorded one with its stamp.

    Parameters
    ----------
    bag : an open one; this closes it.
    topic : of its pictures.
    path : of the file or folder.
    on_fault : takes one line for each fault.
    start_ns : Unix nanoseconds at which time is 0; None for the first picture.
    """

    def __init__(
        self, bag: Bag, topic: Topic, path: Path, on_fault: OnFault, start_ns: int | None
    ) -> None:
        self._bag = bag
        self._topic = topic.name
        self._path = path
        self._on_fault = on_fault
        self._start_ns = start_ns
        self.count = topic.count
        self.fps = self._rate()
        self.places = frozenset([path])

    def __iter__(self) -> Iterator[Frame]:
        decoded = 0
        attitudes = self._attitudes()
        start_ns = self._start_ns
        for index, (logged_ns, message) in enumerate(self._bag.messages(self._topic)):
            stamp_ns = stamp_ns_of(message) or logged_ns
            start_ns = stamp_ns if start_ns is None else start_ns
            try:
                image = picture(message, f"{self._path}: {self._topic}, message {index}")
            except ChromadockError as error:
                self.errors += 1
                self._on_fault(f"{error} (skipped)")
                continue
            decoded += 1
            time_s = (stamp_ns - start_ns) / 1e9
            yield Frame(image, self._path.name, index, time_s, attitudes.get(stamp_ns))
        if self._bag.cut_short is not None:
            self.cut_short = True
            self._on_fault(
                f"{self._path}: the recording is cut short ({self._bag.cut_short}): "
                f"{plural(decoded, 'frame')} could be used"
            )
        elif not decoded:
            raise ChromadockError(f"{self._path}: no picture in {self._topic} can be read")

    def close(self) -> None:
        """Let go of the file."""
        self._bag.close()

    def _attitudes(self) -> dict[int, Attitude]:
        """By the stamp of their frame.

        Raises
        ------
        ChromadockError
            Where one is no attitude.
        """
        there = [one for one in self._bag.topics if one.count != 0]
        if (ATTITUDE, TOPICS[ATTITUDE]) not in [(one.name, one.kind) for one in there]:
            return {}
        try:
            return {
                stamp_ns_of(message): attitude_from_imu(message)
                for _, message in self._bag.messages(ATTITUDE)
            }
        except ChromadockError as error:
            raise ChromadockError(f"{self._path}: {ATTITUDE}: {error}") from None

    def _rate(self) -> float:
        """Frames a second, by the first few."""
        first = itertools.islice(self._bag.messages(self._topic), _RATE_FRAMES)
        stamps = [stamp_ns_of(message) or logged_ns for logged_ns, message in first]
        spans = len(stamps) - 1
        seconds = (stamps[-1] - stamps[0]) / 1e9 if spans > 0 else 0.0
        return spans / seconds if 0 < spans <= 1000 * seconds else DEFAULT_FPS


def open_bag(path: Path, topic: str | None, on_fault: OnFault) -> BagFrames:
    """The frames of a recording.

    Parameters
    ----------
    topic : of its pictures; None for the only one that there is.

    Raises
    ------
    ChromadockError
        Where it cannot be read, or ``topic`` is none of pictures or there are several.
    """
    start_ns = None
    bag: Bag
    if is_mcap(path):
        bag = McapBag(path)
        start_ns = start_of(head(path)[1])
    else:
        bag = RosBag(path)
    try:
        return BagFrames(bag, _chosen(bag, topic, path), path, on_fault, start_ns)
    except ChromadockError:
        bag.close()
        raise


def _chosen(bag: Bag, topic: str | None, path: Path) -> Topic:
    shown = [one for one in bag.topics if one.kind in (IMAGE, COMPRESSED)]
    if topic is None and len(shown) == 1:
        return shown[0]
    for one in shown:
        if one.name == topic:
            return one
    if not shown:
        there = ", ".join(f"{one.name} ({one.kind})" for one in bag.topics) or "no messages"
        raise ChromadockError(
            f"{path}: no pictures in it, but {one_line(there, 300)}: record {IMAGE} or {COMPRESSED}"
        )
    names = ", ".join(one.name for one in shown)
    which = "several topics of pictures" if topic is None else f"no pictures in {topic}"
    raise ChromadockError(f"{path}: {which}: give {path}?topic= with one of {names}")
