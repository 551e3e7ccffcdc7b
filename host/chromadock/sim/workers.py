"""Frames from several processes, in order; the same bytes from any number of them."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import wait
from typing import Any, TypeVar

import cv2

from chromadock.errors import ChromadockError
from chromadock.sim.renderer import Frame
from chromadock.sim.simulation import Simulation, Step

_T = TypeVar("_T")

_AHEAD = 4
"""Frames in work or waiting, a process."""


def rendered(
    simulation: Simulation,
    steps: Iterable[Step],
    jobs: int,
    finish: Callable[[Frame], _T],
) -> Iterator[_T]:
    """``finish`` of the frame of each step, in the order of the steps.

    Parameters
    ----------
    simulation, steps
        What is rendered; steps are taken as frames get done.
    jobs
        Processes, at least 1.
    finish
        Called in those processes: a function of a module, or a partial of one.

    Raises
    ------
    ChromadockError
        What rendering or ``finish`` raises, or where a process dies.
    """
    # Frames are the parallel work; threads inside them would only get in each other's way.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    pool = ProcessPoolExecutor(jobs, _context(), _start, (simulation, finish))
    waiting: deque[Future[_T]] = deque()
    try:
        for step in steps:
            waiting.append(pool.submit(_frame, step))
            if len(waiting) >= _AHEAD * jobs:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    except BrokenProcessPool:
        raise ChromadockError(
            "a process that renders frames died, out of memory perhaps: give fewer --workers"
        ) from None
    finally:
        pool.shutdown(cancel_futures=True)


def _context() -> multiprocessing.context.BaseContext:
    """Processes that share nothing with this one, which has threads."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([__name__])  # imported once for all of them
    return context


_work: Callable[[Step], Any]


def _start(simulation: Simulation, finish: Callable[[Frame], Any]) -> None:
    """Prepare a process."""
    global _work
    _work = lambda step: finish(simulation.frame(step))  # noqa: E731 - it is state, not a name
    cv2.setNumThreads(1)
    # Ctrl-C is the parent's to answer.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with_parent, daemon=True).start()


def _frame(step: Step) -> Any:
    return _work(step)


def _leave_with_parent() -> None:
    """A killed parent takes no leave of its processes."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    wait([parent.sentinel])
    os._exit(1)
