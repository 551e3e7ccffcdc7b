"""The topics that the node tells, as rclpy's publishers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from chromadock.ros.fields import Fields
from chromadock.ros_node.filled import filled, message_class
from chromadock.ros_node.outputs import KINDS

DEPTH = 10
"""Messages that a slow subscriber may be behind; rclpy makes publishers reliable."""


class Publishers:
    """Publishes fields as messages; what a package of messages is missing for is left out.

    Parameters
    ----------
    node : rclpy's.
    topics : keys of ``outputs.KINDS``.
    tell : takes one line about what is left out.
    """

    def __init__(self, node: Any, topics: Iterable[str], tell: Callable[[str], None]) -> None:
        self._open: dict[str, tuple[Any, type[Any]]] = {}
        left_out = []
        for topic in topics:
            try:
                kind = message_class(KINDS[topic])
            except ImportError:
                left_out.append((node.resolve_topic_name(topic), KINDS[topic].split("/")[0]))
                continue
            self._open[topic] = node.create_publisher(kind, topic, DEPTH), kind
        if left_out:
            names = ", ".join(topic for topic, _ in left_out)
            packages = " ".join(f"ros-$ROS_DISTRO-{p.replace('_', '-')}" for _, p in left_out)
            tell(f"not told, for want of their messages: {names}: sudo apt install {packages}")

    def send(self, topic: str, fields: Fields) -> None:
        """Publish a message, unless its topic is none of these."""
        if topic in self._open:
            publisher, kind = self._open[topic]
            publisher.publish(filled(kind, fields))
