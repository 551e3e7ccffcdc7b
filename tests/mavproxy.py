"""MAVProxy, a ground station that was not written here."""

from __future__ import annotations

import os
import re
import select
import subprocess
import sys
import time
from pathlib import Path

from patience import PATIENCE_S

ROOT = Path(__file__).resolve().parents[1]
MAVPROXY = ROOT / "build" / "mavproxy"


class MavProxy:
    """MAVProxy's command line, without windows; its files are below ``folder``, and ``more``
    are further options."""

    def __init__(self, master: str, folder: Path, *more: str) -> None:
        self.said = ""
        environment = {**os.environ, "HOME": str(folder), "PYTHONPATH": str(MAVPROXY)}
        environment.pop("DISPLAY", None)
        self.process = subprocess.Popen(
            [
                *(sys.executable, "-u", "-m", "MAVProxy.mavproxy", f"--master={master}"),
                *(f"--state-basedir={folder}", "--default-modules=param,link", *more),
            ],
            cwd=folder,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            bufsize=0,
        )

    def type(self, line: str) -> None:
        """One command; what was said before is forgotten."""
        assert self.process.stdin is not None
        self.said = ""
        self.process.stdin.write(f"{line}\n".encode())

    def expect(self, pattern: str) -> re.Match[str]:
        """Wait for it."""
        assert self.process.stdout is not None
        end = time.monotonic() + PATIENCE_S
        while (found := re.search(pattern, self.said)) is None:
            assert time.monotonic() < end, f"no {pattern!r} in {self.said!r}"
            if select.select([self.process.stdout], [], [], 0.2)[0]:
                data = self.process.stdout.read(4096)
                assert data, f"it ended: {self.said}"
                self.said += data.decode(errors="replace")
        return found

    def close(self) -> None:
        """End it."""
        self.process.kill()  # asked politely it takes its time, and it keeps nothing of ours
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()
