"""The detector starts no threads of its own: a vehicle's computer has other work for its cores.

A thread of OpenBLAS that waits for another one keeps its core busy meanwhile: a dock at 2 m once
took up to twice as long as it should on a computer that had something else to do.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from bench_scenes import docks, enlarged, plain_water

from chromadock.detector import Detector
from chromadock.dock import DockGeometry

TASKS = Path("/proc/self/task")
LARGER = (1280, 720)
DOCKS = docks(plain_water())
SCENES = DOCKS | {"larger": enlarged(DOCKS["dock at 5 m"], LARGER)}


def busy_ns() -> tuple[int, int]:
    """How long this thread has run, and all others of the process together."""
    own = others = 0
    for task in TASKS.iterdir():
        ran = int((task / "schedstat").read_text().split()[0])
        if int(task.name) == threading.get_native_id():
            own += ran
        else:
            others += ran
    return own, others


@pytest.fixture
def opencv_alone() -> Iterator[None]:
    """OpenCV's own threads are a choice of the user's."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    yield
    cv2.setNumThreads(threads)


@pytest.mark.skipif(not TASKS.is_dir(), reason="tells threads apart by Linux's /proc")
@pytest.mark.usefixtures("opencv_alone")
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("independent", [True, False])
def test_no_other_thread_works_on_a_frame(scene: str, independent: bool) -> None:
    views = [np.roll(SCENES[scene], shift, axis=1) for shift in range(4)]
    detector = Detector(None, DockGeometry.default(), independent=independent)
    assert detector.process(views[0], 0.0).state != "not_found"
    before = busy_ns()
    for turn in range(1, 9):
        detector.process(views[turn % 4], turn / 30)
    own, others = (after - first for after, first in zip(busy_ns(), before, strict=True))
    assert own > 0
    assert others < 0.02 * own
