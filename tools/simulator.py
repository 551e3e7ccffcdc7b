"""A simulated dock in a process of its own, for tests."""

from __future__ import annotations

import re
import select
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

START_TIMEOUT_S = 60.0
_URL = re.compile(r"(/dev/\S+|socket://[^\s,;]+)")


class Simulator:
    """A process of ``chromadock dock simulate``; ``url`` is its port."""

    def __init__(self, log: Path, arguments: Sequence[str | Path] = ()) -> None:
        log.parent.mkdir(parents=True, exist_ok=True)
        with log.open("wb") as errors:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "chromadock", "dock", "simulate", *map(str, arguments)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=errors,
                bufsize=0,
            )
        try:
            self.url = self._wait_for_url(log)
        except BaseException:
            self.stop()
            raise

    def stop(self) -> int:
        """End it and return its exit status."""
        self.process.terminate()
        try:
            status = self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()
        return status

    def _wait_for_url(self, log: Path) -> str:
        assert self.process.stdout is not None
        said = b""
        end = time.monotonic() + START_TIMEOUT_S
        while time.monotonic() < end:
            if not select.select([self.process.stdout], [], [], 0.1)[0]:
                continue
            data = self.process.stdout.read(4096)
            if not data:
                break
            said += data
            # A whole line, or the name may be cut.
            if found := _URL.search(said.decode(errors="replace").rpartition("\n")[0]):
                return found[1]
        raise RuntimeError(
            f"the simulated dock names no port: {said.decode(errors='replace')}{log.read_text()}"
        )
