"""The closed loop for ten minutes: .venv/bin/python tools/closed_loop.py, by way of `make soak`.

`chromadock dock simulate` sees a pool's water and decides on a colour.  The vehicle's pictures are
rendered with the lamps as that dock drives them, and streamed by RTSP in real time.
`chromadock run` finds the dock in them, records, draws its overlay, serves its page and tells an
autopilot, which sends attitudes.  In the middle the dock's lamps are put out by a command
for a while: the pictures follow what the dock reports.

Exit status: 0 all well, 1 a fault, 3 no GStreamer here.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
from pathlib import Path
from typing import Any

import numpy as np
from closed_loop_autopilot import Autopilot
from closed_loop_pictures import Duties, Film, lamps
from simulator import Simulator
from soak import resident_kib

from chromadock.link import open_dock

sys.path.insert(0, str(Path(__file__).resolve().parent / "setup"))
from debian import SYSTEM_PYTHON, has_streamer

FPS = 15
DARK_S = 4.0
GIVE_UP_S = 2.0
"""Of darkness after which nothing may be told of the dock; and to say so again, of light."""
AGAIN_S = 4.0
MOST_RANGE_ERROR = 0.05
"""In 99 of 100 messages."""
MOST_CHANGE = 0.1
"""Of a lamp's power, from what the pictures are rendered with: the water moves a little."""
MOST_GROWTH_KIB = 16_384
START_S = 40.0


class ClosedLoop:
    """One run: ``faults`` tells in lines what went wrong, ``figures`` what was measured.

    ``least_hz``: targets a second that the autopilot must be told at least, while there is light.
    """

    def __init__(self, folder: Path, seconds: float, least_hz: float = 5.0) -> None:
        self.folder = folder
        self.seconds = seconds
        self.least_hz = least_hz
        self.faults: list[str] = []
        self.figures: list[str] = []
        self.taken: list[tuple[float, int, str]] = []
        self.memory_kib: list[tuple[float, int]] = []
        self.status: dict[str, Any] = {}
        self.changed = 0.0

    def run(self) -> None:
        """All of it."""
        film = Film.of(FPS)
        film.write_water(self.folder / "water")
        film.write_calibration(self.folder / "camera.yaml")
        dock = Simulator(self.folder / "dock.log", [self.folder / "water", "--fps", "10"])
        try:
            with open_dock(dock.url) as client:
                duties = _settled(client)
                self.figures.append(f"the dock decided on duties {duties}")
                ranges_m = film.write(self.folder / "lit.bgr", duties)
                film.write(self.folder / "dark.bgr", None)
                self._with_camera(film, client, duties)
        finally:
            dock.stop()
        self._judge(np.array(ranges_m))

    def _with_camera(self, film: Film, client: Any, duties: Duties) -> None:
        size = [str(side) for side in film.size]
        script = str(Path(__file__).with_name("closed_loop_camera.py"))
        with subprocess.Popen(
            [SYSTEM_PYTHON, script, str(self.folder), *size, str(FPS)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        ) as camera:  # fmt: skip
            try:
                assert camera.stdout is not None
                url = f"rtsp://127.0.0.1:{camera.stdout.readline().strip()}/camera"
                reader = threading.Thread(target=self._note, args=(camera,), daemon=True)
                reader.start()
                self._with_vehicle(url, camera, client, duties)
            finally:
                camera.kill()
        reader.join()

    def _note(self, camera: subprocess.Popen[str]) -> None:
        assert camera.stdout is not None
        for line in camera.stdout:
            taken_ms, frame, which = line.split()
            self.taken.append((float(taken_ms) / 1000, int(frame), which))

    def _with_vehicle(
        self, url: str, camera: subprocess.Popen[str], client: Any, duties: Duties
    ) -> None:
        port, page = _free_port(socket.SOCK_DGRAM), _free_port(socket.SOCK_STREAM)
        out = f"mavlink:udpin:127.0.0.1:{port}?receiver=ardupilot-rover&vision=on&rate_hz={FPS}"
        (self.folder / "vehicle.toml").write_text(
            f'[camera]\nsource = "{url}"\ncalibration = "camera.yaml"\n'
            f'[outputs]\nresults = ["{out}", "http:{page}"]\n'
            'record = "dive.mcap"\noverlay = "seen.mp4"\n'
        )
        command = [sys.executable, "-m", "chromadock", "run", "vehicle.toml"]
        self.autopilot = Autopilot(port)
        with (self.folder / "run.log").open("w") as log:
            run = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=log)
        try:
            self._wait_for_targets(run)
            self._go_on(run, camera, client, duties)
            self.status = _status(page)
            run.send_signal(signal.SIGTERM)
            if run.wait(20) != 0:
                self.faults.append(f"the run ended with {run.returncode}")
        finally:
            run.kill()
            run.wait()
            self.autopilot.stop()

    def _wait_for_targets(self, run: subprocess.Popen[bytes]) -> None:
        end_s = time.monotonic() + START_S
        while len(self.autopilot.heard.targets) < FPS:
            if time.monotonic() > end_s or run.poll() is not None:
                said = (self.folder / "run.log").read_text()
                raise RuntimeError(f"the autopilot is told nothing: {said}")
            time.sleep(0.1)

    def _go_on(
        self,
        run: subprocess.Popen[bytes],
        camera: subprocess.Popen[str],
        client: Any,
        duties: Duties,
    ) -> None:
        """For the time that was asked for: show what the dock's lamps do, and measure."""
        self.start_s = time.monotonic()
        out_s, shown = self.start_s + self.seconds / 2, "lit"
        commanded, dark_s = "lit", math.inf
        used_s = _processor_s(run.pid)
        assert camera.stdin is not None
        while (now_s := time.monotonic()) < self.start_s + self.seconds and run.poll() is None:
            if commanded == "lit" and out_s <= now_s < dark_s:
                client.led_raw(0, 0, 0)
                commanded = "dark"
            elif commanded == "dark" and now_s > dark_s + DARK_S:
                client.led_auto()
                commanded = "lit"
            # What the dock reports, not what it was told, is shown.
            light = lamps(client.status().duty)
            which = "lit" if any(light) else "dark"
            if any(light):
                self.changed = max(self.changed, *np.abs(np.subtract(light, lamps(duties))))
            if which != shown:
                shown = which
                dark_s = min(dark_s, now_s) if which == "dark" else dark_s
                camera.stdin.write(f"{which}\n")
                camera.stdin.flush()
            self.memory_kib.append((now_s - self.start_s, resident_kib(run.pid)))
            time.sleep(0.1)
        self.lasted_s = time.monotonic() - self.start_s
        self.processor_s = _processor_s(run.pid) - used_s

    def _judge(self, ranges_m: Any) -> None:
        targets = np.array([t for t in self.autopilot.heard.targets if t[0] >= self.start_s])
        times = np.array([taken_s for taken_s, _, _ in self.taken])
        # A message's stamp is of its picture, but for the encoder: less than a frame.
        which = np.searchsorted(times, targets[:, 1] + 0.005) - 1
        latencies_ms = 1000 * (targets[:, 0] - times[which])
        true_m = ranges_m[[self.taken[k][1] for k in which]]
        errors = np.abs(targets[:, 2] / true_m - 1)
        self._figures(targets, latencies_ms, errors)
        self._faults(targets, errors)
        self._darkness(targets[:, 0])

    def _figures(self, targets: Any, latencies_ms: Any, errors: Any) -> None:
        median, most = np.quantile(latencies_ms, (0.5, 0.99))
        early, late = self._memory_kib()
        frames, dropped = self.status["frames"], self.status["dropped"]
        counts = self.autopilot.heard.counts
        self.figures += [
            f"{self.lasted_s:.0f} s at {FPS} frames/s",
            f"from a picture's capture to its message at the autopilot: {median:.0f} ms in the "
            f"median, {most:.0f} ms at most in 99 of 100, encoder and network included",
            f"frames: {frames} used, {dropped} dropped for newer ones",
            f"messages: {', '.join(f'{n} {name}' for name, n in sorted(counts.items()))}",
            f"processor: {100 * self.processor_s / self.lasted_s:.0f} % of one core",
            f"memory: {early} KiB after {self._settled_s():.0f} s, {late} at the end, "
            f"{late - early:+}",
            f"range told against the truth: {100 * np.median(errors):.1f} % in the median, "
            f"{100 * errors.max():.1f} % at most, of {len(targets)}",
        ]

    def _faults(self, targets: Any, errors: Any) -> None:
        if (most := np.quantile(errors, 0.99)) > MOST_RANGE_ERROR:
            self.faults.append(f"ranges were told that are {100 * most:.0f} % off")
        lit = self.lasted_s - DARK_S - AGAIN_S
        if len(targets) < self.least_hz * lit:
            self.faults.append(
                f"only {len(targets)} targets: fewer than {self.least_hz:g} a second"
            )
        if self.changed > MOST_CHANGE:
            self.faults.append(f"the dock's light changed by {100 * self.changed:.0f} %")
        early, late = self._memory_kib()
        if late - early > MOST_GROWTH_KIB:
            self.faults.append(f"memory grew by {late - early} KiB")
        for name in ("dive.mcap", "seen.mp4"):
            if not (self.folder / name).is_file():
                self.faults.append(f"{name} was not written")

    def _darkness(self, told_s: Any) -> None:
        """Whether the vehicle is silent while its pictures show a dark dock, and only then.

        ``told_s``: when the autopilot was told of the dock.
        """
        dark = [taken_s for taken_s, _, which in self.taken if which == "dark"]
        shown = [which for _, _, which in self.taken]
        changes = sum(one != next_ for one, next_ in itertools.pairwise(shown))
        if changes != 2:
            self.faults.append(f"the pictures changed {changes} times between lit and dark")
            return
        told = (told_s > dark[0] + GIVE_UP_S) & (told_s < dark[-1])
        if told.any():
            self.faults.append(f"{told.sum()} targets were told of a dock that is dark")
        again = told_s[told_s > dark[-1]]
        if not len(again) or again[0] > dark[-1] + AGAIN_S:
            self.faults.append("the dock was not told again once it was lit")

    def _settled_s(self) -> float:
        """When all is loaded: a minute, or a third of a short run."""
        return min(60.0, self.seconds / 3)

    def _memory_kib(self) -> tuple[int, int]:
        """Then, and at the end."""
        early = next(kib for at_s, kib in self.memory_kib if at_s >= self._settled_s())
        return early, self.memory_kib[-1][1]


def _settled(client: Any) -> Duties:
    """The duties of the dock's lamps, once they have hardly changed for two seconds."""
    red, green, blue = client.status().duty
    since_s, end_s = time.monotonic(), time.monotonic() + 30
    while time.monotonic() < end_s:
        duties = client.status().duty
        if np.abs(np.subtract(lamps(duties), lamps((red, green, blue)))).max() > MOST_CHANGE / 5:
            (red, green, blue), since_s = duties, time.monotonic()
        if any(lamps((red, green, blue))) and time.monotonic() - since_s > 2:
            return red, green, blue
        time.sleep(0.1)
    raise RuntimeError("the dock does not settle on a colour")


def _status(port: int) -> dict[str, Any]:
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/status.json", timeout=5) as answer:
        found: dict[str, Any] = json.load(answer)
        return found


def _processor_s(pid: int) -> float:
    """What a process has used of the processor so far; 0 where it is gone."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _free_port(kind: socket.SocketKind) -> int:
    with socket.socket(socket.AF_INET, kind) as end:
        end.bind(("127.0.0.1", 0))
        return int(end.getsockname()[1])


def main() -> int:
    """Run it, print the figures and return the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split(":")[0])
    parser.add_argument("--seconds", type=float, default=600.0)
    options = parser.parse_args()
    if not has_streamer():
        print("no GStreamer with RTSP server here", file=sys.stderr)
        return 3
    with tempfile.TemporaryDirectory() as folder:
        loop = ClosedLoop(Path(folder), options.seconds)
        loop.run()
    for line in loop.figures:
        print(line)
    for fault in loop.faults:
        print(f"FAIL: {fault}")
    print(f"{len(loop.faults)} faults")
    return 1 if loop.faults else 0


if __name__ == "__main__":
    sys.exit(main())
