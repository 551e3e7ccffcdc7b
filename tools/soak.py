"""A simulated dock on a bad line: .venv/bin/python tools/soak.py, by way of `make soak`.

Ten minutes at 30 frames a second with 1 % of all bytes damaged, both ways, `chromadock dock
watch` reading all along.  Nothing may hang or grow, and no wrong colour may be shown: what the
dock reports is compared, ahead of the damage, with what the frames demand.
"""

from __future__ import annotations

import argparse
import re
import select
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from simulator import Simulator
from soak_line import BadLine
from soak_truth import Truth, write_frames

from chromadock import dialect
from chromadock.link.commands import command_long
from chromadock.parameter_table import PARAMETERS

SHARE = 0.01
FPS = 30
LONGEST_GAP_MS = 1500
LONGEST_SILENCE_S = 5.0
MOST_GROWTH_KIB = 2048
_SAY_PERIOD_S = 0.1
_SAMPLE_PERIOD_S = 1.0
_WATCHED = re.compile(rb"marker (\S+?)\xc2\xb0  duties (\d+) (\d+) (\d+)")
# The defaults again, and REPORT_HZ as it is: only a damaged one could change anything.
CHANGED = {"REPORT_HZ": 30.0}
EXPECTED = {p.name: CHANGED.get(p.name, p.default) for p in PARAMETERS}


def set_message(name: str, value: float) -> Any:
    """PARAM_SET."""
    kind = dialect.MAV_PARAM_TYPE_REAL32
    return dialect.MAVLink_param_set_message(50, 1, name.encode(), value, kind)


class Soak:
    """One run, of which ``faults`` tells in lines what went wrong."""

    def __init__(self, folder: Path, seconds: float, seed: int) -> None:
        self.seconds = seconds
        self.faults: list[str] = []
        frames = folder / "frames"
        frames.mkdir()
        self.truth = Truth(write_frames(frames))
        arguments = [frames, "--tcp", "localhost:0", "--fps", str(FPS)]
        self.simulator = Simulator(folder / "simulator.log", arguments)
        self.line = BadLine(self.simulator.url, SHARE, seed, self._overhear)
        self.parameters: dict[str, float] = {}
        self.resident: dict[str, list[int]] = {"dock": [], "watch": []}
        self.watched = 0
        self.lasted_s = 0.0
        self.longest_silence_s = 0.0
        self._errors = folder / "watch.log"

    def run(self) -> None:
        """All of it."""
        try:
            self._speed_up()
            self._watch()
            self._ask_all()
        finally:
            self.line.close()
            self.simulator.stop()
        self._judge()

    def _speed_up(self) -> None:
        """A report of each frame, as far as the core's clock allows."""
        end = time.monotonic() + 10
        while self.parameters.get("REPORT_HZ") != CHANGED["REPORT_HZ"]:
            if time.monotonic() > end:
                raise RuntimeError("the dock does not take REPORT_HZ")
            self.line.say(set_message("REPORT_HZ", CHANGED["REPORT_HZ"]), damaged=False)
            self.line.step(0.2)

    def _watch(self) -> None:
        command = [sys.executable, "-m", "chromadock", "dock", "watch", "--timeout", "60"]
        with self._errors.open("wb") as errors:
            watch = subprocess.Popen(
                [*command, "--port", self.line.url],
                stdout=subprocess.PIPE,
                stderr=errors,
                bufsize=0,
            )
        try:
            self._until_shown(watch)
            self._go_on(watch)
            if watch.poll() is not None:
                self.faults.append(f"watch ended: {self._errors.read_text().strip()}")
        finally:
            watch.terminate()
            watch.wait()
            assert watch.stdout is not None
            watch.stdout.close()

    def _until_shown(self, watch: subprocess.Popen[bytes]) -> None:
        """On this line the greeting takes a few tries."""
        end = time.monotonic() + 60
        while not self._read(watch) and time.monotonic() < end and watch.poll() is None:
            self.line.step(0.01)

    def _go_on(self, watch: subprocess.Popen[bytes]) -> None:
        start = heard = time.monotonic()
        said = sampled = 0
        while (now := time.monotonic()) < start + self.seconds and watch.poll() is None:
            self.line.step(0.01)
            if self._read(watch):
                self.longest_silence_s = max(self.longest_silence_s, now - heard)
                heard = now
            if now >= start + said * _SAY_PERIOD_S:
                self.line.say(self._remark(said))
                said += 1
            if now >= start + sampled * _SAMPLE_PERIOD_S:
                sampled += 1
                for name, process in (("dock", self.simulator.process), ("watch", watch)):
                    self.resident[name].append(resident_kib(process.pid))
        end = time.monotonic()
        self.lasted_s = end - start
        self.longest_silence_s = max(self.longest_silence_s, end - heard)

    def _remark(self, number: int) -> Any:
        if number % 4 == 0:
            return command_long(dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_AUTO)
        if number % 4 == 1:
            return dialect.MAVLink_param_request_read_message(50, 1, b"", number % len(EXPECTED))
        name = list(EXPECTED)[number % len(EXPECTED)]
        return set_message(name, EXPECTED[name])

    def _read(self, watch: subprocess.Popen[bytes]) -> bool:
        """Lines of `watch`, each checked; whether there were any."""
        assert watch.stdout is not None
        if not select.select([watch.stdout], [], [], 0)[0]:
            return False
        found = _WATCHED.findall(watch.stdout.read(65536))
        for degrees, *duties in found:
            self.watched += 1
            hue = None if degrees == b"-" else round(float(degrees) * 1536 / 360) % 1536
            real = {(h, d) for _, _, h, d in self.truth.shown}
            if (hue, tuple(map(int, duties))) not in real:
                self.faults.append(f"watch shows hue {hue}, duties {duties}: nothing the dock sent")
        return bool(found)

    def _overhear(self, message: Any) -> None:
        if message.get_type() == "DOCK_STATUS":
            self.truth.take(message)
        elif message.get_type() == "PARAM_VALUE":
            self.parameters[message.param_id] = message.param_value
            expected = EXPECTED[message.param_id]
            if abs(message.param_value - expected) > 1e-4:
                self.faults.append(f"{message.param_id} is {message.param_value:g}")

    def _ask_all(self) -> None:
        """Every parameter at the end; half a damaged message may still be in its way."""
        self.parameters.clear()
        end = time.monotonic() + 10
        asked = 0.0
        while len(self.parameters) < len(EXPECTED) and (now := time.monotonic()) < end:
            if now > asked + 1:
                asked = now
                self.line.say(dialect.MAVLink_param_request_list_message(50, 1), damaged=False)
            self.line.step(0.05)
        if len(self.parameters) < len(EXPECTED):
            self.faults.append("the dock does not list its parameters at the end")

    def _judge(self) -> None:
        self.faults += self.truth.wrong
        if self.truth.checked < 0.5 * FPS * self.seconds:
            self.faults.append(f"only {self.truth.checked} reports of the dock")
        if self.truth.longest_gap_ms > LONGEST_GAP_MS:
            self.faults.append(f"no report of the dock for {self.truth.longest_gap_ms} ms")
        if self.longest_silence_s > LONGEST_SILENCE_S:
            self.faults.append(f"nothing from watch for {self.longest_silence_s:.1f} s")
        for name in self.resident:
            if self.growth_kib(name) > MOST_GROWTH_KIB:
                self.faults.append(f"{name} grew by {self.growth_kib(name)} KiB")

    def growth_kib(self, name: str) -> int:
        """From a third of the run, when all is loaded, to its end."""
        samples = self.resident[name]
        return samples[-1] - samples[len(samples) // 3] if samples else 0

    def figures(self) -> list[str]:
        """What was measured."""
        (down, up), (bad_down, bad_up) = self.line.moved, self.line.damaged
        lines = [
            f"{self.lasted_s:.0f} s at {FPS} frames/s: {self.truth.checked} reports of the dock "
            f"checked, {len(self.truth.wrong)} wrong; {self.watched} lines of watch checked",
            f"bytes to the host {down}, {bad_down} damaged; to the dock {up}, {bad_up} damaged; "
            f"{self.truth.link_faults} messages refused by the dock",
            f"longest gap between reports {self.truth.longest_gap_ms} ms, "
            f"between lines of watch {self.longest_silence_s:.1f} s",
        ]
        for name, samples in self.resident.items():
            if samples:
                lines.append(
                    f"memory of {name}: {samples[0]} KiB at the start, {max(samples)} at most, "
                    f"{samples[-1]} at the end; {self.growth_kib(name):+} since the first third"
                )
        return lines


def resident_kib(pid: int) -> int:
    """Resident memory of a process; 0 where it is gone."""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0
    found = re.search(r"VmRSS:\s+(\d+) kB", status)
    return int(found[1]) if found else 0


def main() -> int:
    """Run it, print the figures and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--seed", type=int, default=1, help="of the damage")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(Path(folder), options.seconds, options.seed)
        soak.run()
    for line in soak.figures():
        print(line)
    for fault in soak.faults[:20]:
        print(f"FAIL: {fault}")
    print(f"{len(soak.faults)} faults")
    return 1 if soak.faults else 0


if __name__ == "__main__":
    sys.exit(main())
