"""Files of ROS messages: MCAP files, ROS 2 bags, ROS 1 bags."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from chromadock.closable import Closable


@dataclass(frozen=True)
class Topic:
    """A topic: its name, the type of its messages, such as ``sensor_msgs/msg/Image``, and how
    many there are, None where only reading it all would tell."""

    name: str
    kind: str
    count: int | None


class Bag(Closable, ABC):
    """An open file of messages; a context manager.

    Attributes
    ----------
    topics
        What is in it.
    cut_short
        Why its end is missing, in a few words, once that was found; None of a whole one.
    """

    topics: list[Topic]
    cut_short: str | None = None

    @abstractmethod
    def messages(self, topic: str) -> Iterator[tuple[int, Any]]:
        """Unix nanoseconds at which each message of a topic was logged, and the message, in the
        order of the file.  The fields of a message are its attributes.
        """

    @abstractmethod
    def close(self) -> None:
        """Let go of the file."""
