"""The node of ROS 2 and another one beside it, each a process in the environment build/ros."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sysconfig
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from patience import PATIENCE_S
from step import missing

ROOT = Path(__file__).resolve().parents[1]
PYTHON = ROOT / "build" / "ros" / "bin" / "python"

Message = dict[str, Any]


def environment(folder: Path) -> dict[str, str]:
    """Packages of .venv beside those of build/ros, and a ROS that is heard on this computer only,
    apart from others by its domain, with its logs in ``folder``."""
    if not PYTHON.exists():
        pytest.skip(f"ros: {missing('ros') or 'not in build/ros: run make setup'}")
    packages = os.pathsep.join([sysconfig.get_path("purelib"), str(ROOT / "host")])
    return {
        **os.environ,
        "PYTHONPATH": packages,
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_DOMAIN_ID": str(1 + os.getpid() % 101),
        "ROS_HOME": str(folder),
        "RCUTILS_COLORIZED_OUTPUT": "0",
    }


class Peer:
    """The program ``ros_peer.py``: what it is told to publish, and what it hears."""

    def __init__(self, folder: Path, reliability: str) -> None:
        self.heard: list[Message] = []
        self._lines: queue.Queue[str] = queue.Queue()
        self._process = subprocess.Popen(
            [str(PYTHON), str(ROOT / "tests" / "ros_peer.py"), reliability],
            env=environment(folder),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        threading.Thread(target=self._read, daemon=True).start()

    def publish(self, order: Message) -> None:
        """Have it publish a picture and what belongs to it."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()

    def wait(
        self, wanted: Callable[[Message], bool], seconds: float = PATIENCE_S
    ) -> Message | None:
        """The first message that comes from now on that is wanted; None where none comes."""
        end_s = time.monotonic() + seconds
        while (left_s := end_s - time.monotonic()) > 0:
            with contextlib.suppress(queue.Empty):
                self.heard.append(json.loads(self._lines.get(timeout=left_s)))
                if wanted(self.heard[-1]):
                    return self.heard[-1]
        return None

    def close(self) -> None:
        """End it."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with contextlib.suppress(ValueError):  # closed
            for line in self._process.stdout:
                self._lines.put(line)


class Node:
    """``chromadock ros`` with arguments; a context manager that leaves no process behind."""

    def __init__(self, folder: Path, *arguments: object) -> None:
        self._said = folder / "said.txt"
        with self._said.open("w") as said:
            self.process = subprocess.Popen(
                [str(PYTHON), "-m", "chromadock", "ros", *map(str, arguments)],
                env=environment(folder),
                stdout=said,
                stderr=said,
            )

    @property
    def said(self) -> str:
        """All that it has printed so far."""
        return self._said.read_text()

    def end(self, number: int = signal.SIGTERM) -> int:
        """Its exit status after a signal."""
        self.process.send_signal(number)
        return self.process.wait(PATIENCE_S)

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()


@contextlib.contextmanager
def running(
    folder: Path, *arguments: object, reliability: str = "RELIABLE"
) -> Iterator[tuple[Node, Peer]]:
    """Both, after they have found each other."""
    with (
        Node(folder, *arguments) as node,
        contextlib.closing(Peer(folder, reliability)) as peer,
    ):
        assert peer.wait(lambda m: m["topic"] == "ready"), node.said
        yield node, peer


def stamp_ns(message: Message) -> int:
    """Of its header."""
    stamp = message["header"]["stamp"]
    return int(stamp["sec"]) * 10**9 + int(stamp["nanosec"])
