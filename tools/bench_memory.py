"""What the host takes of memory.

Each measurement runs in a process of its own: this file, with what to do as its arguments.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import cv2
from bench_scenes import VGA, docks, photographs, plain_water

from chromadock import Detector, DockGeometry

FRAMES = 10_000
SETTLED = 200
"""Frames after which all that is prepared once is prepared."""
PHOTOGRAPHS = 6  # that a run cycles over, besides water and docks
FPS = 30


@dataclass(frozen=True, slots=True)
class LongRun:
    """Resident memory of one detector's run, MiB: after SETTLED frames, at its end, largest."""

    frames: int
    settled_mib: float
    end_mib: float
    largest_mib: float


def resident_mib(frames: int = 60) -> float:
    """Most memory that ``chromadock detect`` holds on a VGA video, MiB."""
    with tempfile.TemporaryDirectory() as folder:
        video = str(Path(folder) / "vga.mp4")
        writer = cv2.VideoWriter(video, cv2.VideoWriter_fourcc(*"mp4v"), FPS, VGA)
        for _ in range(frames):
            writer.write(plain_water())
        writer.release()
        # The figure is the largest of all the process's children.
        done = subprocess.run(
            [sys.executable, __file__, "video", video], check=True, capture_output=True, text=True
        )
    return float(done.stdout)


def long_runs(frames: int = FRAMES) -> dict[str, LongRun]:
    """Both kinds of run at once, by name: each frame alone, and frames in sequence."""
    running = {
        kind: subprocess.Popen(
            [sys.executable, __file__, kind, str(frames)], stdout=subprocess.PIPE, text=True
        )
        for kind in ("independent", "in sequence")
    }
    said = {kind: process.communicate()[0] for kind, process in running.items()}
    for process in running.values():
        if process.returncode:
            raise subprocess.CalledProcessError(process.returncode, process.args)
    return {kind: LongRun(**json.loads(text)) for kind, text in said.items()}


def long_run(frames: int, independent: bool) -> LongRun:
    """One detector over different VGA frames in turns."""
    cv2.setNumThreads(1)
    scenes = list(photographs().values())[:PHOTOGRAPHS]
    scenes = [plain_water(), *scenes, *docks(scenes[0] if scenes else plain_water()).values()]
    detector = Detector(None, DockGeometry.default(), independent=independent)
    resident = []
    for i in range(frames):
        detector.process(scenes[i % len(scenes)], i / FPS)
        if i >= min(SETTLED, frames // 2):
            resident.append(_resident_mib())
    return LongRun(frames, resident[0], resident[-1], max(resident))


def _resident_mib() -> float:
    """What this process holds now; Linux."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def main() -> None:
    """Run ``chromadock detect`` on a video, or a long run, and print the memory it took."""
    what, argument = sys.argv[1:]
    if what == "video":
        detect = [sys.executable, "-m", "chromadock", "detect", argument, "--json"]
        subprocess.run(detect, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)
    else:
        print(json.dumps(asdict(long_run(int(argument), what == "independent"))))


if __name__ == "__main__":
    main()
