"""The topics that the node hears, as rclpy's subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from chromadock.ros_node.filled import message_class

RENEW_S = 0.5
"""So often it is looked how publishers tell."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """A topic by its full name, the type of its messages, who takes them, and how many may wait."""

    topic: str
    kind: str
    take: Callable[[Any], None]
    depth: int


class Subscriptions:
    """Hears each topic as its publishers tell it.

    A subscription by best effort, the usual one for sensors, hears every publisher; but Fast DDS
    then loses every second raw picture of 640 x 480, of a reliable publisher too, even between two
    processes of one computer.  And what was told once, before the node came, only a transient local
    subscription hears.  So both are taken where all publishers of a topic offer them.

    Parameters
    ----------
    node : rclpy's.
    wanted : of messages that wait, those of an earlier topic are taken first.
    now_s : this moment, seconds of any clock.
    """

    def __init__(self, node: Any, wanted: Sequence[Wanted], now_s: float) -> None:
        self._node = node
        self._open: dict[Wanted, tuple[Any, QoSProfile]] = {}
        for one in wanted:
            self._open[one] = self._subscribed(one, self._offered(one))
        self._looked_s = now_s

    def renew(self, now_s: float) -> None:
        """Look how the publishers tell by now, if it is time, and follow."""
        if now_s - self._looked_s < RENEW_S:
            return
        self._looked_s = now_s
        for one, (subscription, before) in self._open.items():
            offered = self._offered(one)
            if offered != before:
                self._node.destroy_subscription(subscription)
                self._open[one] = self._subscribed(one, offered)

    def _offered(self, one: Wanted) -> QoSProfile:
        """What all publishers of a topic offer; the least without any."""
        found = [p.qos_profile for p in self._node.get_publishers_info_by_topic(one.topic)]
        reliable = all(q.reliability == ReliabilityPolicy.RELIABLE for q in found)
        kept = all(q.durability == DurabilityPolicy.TRANSIENT_LOCAL for q in found)
        return QoSProfile(
            depth=one.depth,
            reliability=ReliabilityPolicy.RELIABLE
            if found and reliable
            else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL
            if found and kept
            else DurabilityPolicy.VOLATILE,
        )

    def _subscribed(self, one: Wanted, qos: QoSProfile) -> tuple[Any, QoSProfile]:
        kind = message_class(one.kind)
        return self._node.create_subscription(kind, one.topic, one.take, qos), qos
