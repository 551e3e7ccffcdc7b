"""The processes that do the work: some on this machine, or those of a Dask scheduler."""

from __future__ import annotations

import gc
import logging
import signal
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import dask
from distributed import Client, Future, LocalCluster, Worker, WorkerPlugin
from distributed.scheduler import KilledWorker

from chromadock.errors import ChromadockError
from chromadock.evaluate.version import versions
from chromadock.text import one_line, plural

Warn = Callable[[str], None]
"""Takes a line that the user should see."""

_CONNECT_S = 10

# By default Dask has the C library (glibc; others ignore this) hand memory back at once, and
# arrays of a picture's size are mapped anew each time: half of the whole time would go into that.
_ENVIRONMENT = "distributed.nanny.pre-spawn-environ"
_KEEP_MEMORY = {
    f"{_ENVIRONMENT}.MALLOC_TRIM_THRESHOLD_": 1 << 28,
    f"{_ENVIRONMENT}.MALLOC_MMAP_THRESHOLD_": 1 << 25,  # the most that it takes
}


def cluster_of(scheduler: str | None, workers: int, warn: Warn) -> AbstractContextManager[Client]:
    """The workers of the ``scheduler`` at an address, or else ``workers`` of this machine; see
    ``remote_cluster`` and ``local_cluster``."""
    return local_cluster(workers) if scheduler is None else remote_cluster(scheduler, warn)


@contextmanager
def local_cluster(workers: int) -> Iterator[Client]:
    """``workers`` processes of one thread each on this machine; a dead one is replaced."""
    _quiet_dask()
    with (
        dask.config.set(_KEEP_MEMORY),
        LocalCluster(  # type: ignore[no-untyped-call]
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address=":0",
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster) as client,  # type: ignore[no-untyped-call]
    ):
        client.register_plugin(_DeafToCtrlC())
        yield client


class _DeafToCtrlC(WorkerPlugin):
    """A terminal sends Ctrl-C to all processes; only the one that the user started tells of it."""

    def setup(self, worker: Worker) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


class ClusterLostError(ChromadockError):
    """Whatever is still to be done, nobody does it."""


def _quiet_dask() -> None:
    """Keep its loggers, which have levels of their own, from telling of what is dealt with:
    lost workers, whose work is done again, and a lost scheduler, which is one line of ours."""
    for name in list(logging.root.manager.loggerDict):
        if name.split(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)


@contextmanager
def remote_cluster(address: str, warn: Warn) -> Iterator[Client]:
    """The workers of a scheduler that somebody started, such as ``tcp://10.0.0.7:8786``.

    Other versions there than here are told to ``warn``: their figures may differ.

    Raises
    ------
    ChromadockError
        Where no scheduler answers, or it has no workers, or they lack this package.
    """
    _quiet_dask()
    fault = ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # told below, in a line
            client = Client(address, timeout=_CONNECT_S)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        fault = one_line(error, 80)
    if fault:
        # A client that came to nothing closes itself when it is collected, and waits for ever
        # where that happens to be within the start of another: so now.
        gc.collect()
        raise ChromadockError(
            f"--scheduler {address}: nobody answers ({fault}): "
            "start `dask scheduler` there, or leave the option out"
        )
    with client:
        _compare_versions(client, address, warn)
        yield client


def result_of(future: Future[Any]) -> Any:
    """What the worker returned.

    Raises
    ------
    ChromadockError
        Its own, or one line where the workers are lost.
    """
    try:
        return future.result()
    except KilledWorker as error:
        raise ChromadockError(
            f"the same piece of work ended {error.allowed_failures + 1} workers: "
            "they may lack memory; use fewer --workers"
        ) from None
    except CancelledError:
        raise ClusterLostError(
            "the scheduler is gone: start it, then give the same command again"
        ) from None


def _compare_versions(client: Client, address: str, warn: Warn) -> None:
    """Warn where a worker would compute with other code than this process."""
    try:
        theirs = client.run(versions)
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"--scheduler {address}: its workers lack the package {error.name}: "
            "install chromadock[evaluate] there"
        ) from None
    if not theirs:
        raise ChromadockError(
            f"--scheduler {address}: it has no workers: start `dask worker {address}` somewhere"
        )
    for what, here in versions().items():
        others = {there.get(what, "unknown") for there in theirs.values()} - {here}
        if others:
            warn(
                f"warning: {what} is {here} here and {' and '.join(sorted(others))} on "
                f"{plural(len(theirs), 'worker')}: figures may differ"
            )
