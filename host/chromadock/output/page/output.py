"""Results as a live page, for a browser."""

from __future__ import annotations

import time
from collections.abc import Mapping

from chromadock.output.page.server import Server
from chromadock.output.page.status import Status
from chromadock.output.results import ResultOutput
from chromadock.output.run_setup import RunSetup
from chromadock.results.detection import Detection
from chromadock.sources import Frame


class PageOutput(ResultOutput):
    """Serves the page from when it is opened; one may outlive several runs, ``begin`` by ``begin``.

    Raises
    ------
    ChromadockError
        Where the port is taken, or the address is none.
    """

    def __init__(self, host: str, port: int) -> None:
        self._name = f"http:{host}:{port}"
        self._status = Status()
        self._server = Server(host, port, self._status)

    def __str__(self) -> str:
        return self._name

    def begin(self, setup: RunSetup | None) -> None:
        """A run begins, set to this; None where nobody knows."""
        self._status.begin(setup)

    def fails(self, line: str) -> None:
        """Show what keeps the run from going on."""
        self._status.fails(line)

    def beside(self, outputs: Mapping[str, ResultOutput]) -> None:
        """Show how these do."""
        self._status.beside(outputs)

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Show a frame to whoever looks."""
        self._status.take(frame, detection, age_s, time.monotonic())

    def close(self) -> None:
        """End the page."""
        self._server.close()
