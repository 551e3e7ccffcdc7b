"""``chromadock simulate``: frames of a dock under water, with the truth beside them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from chromadock.choices import DEFAULT_MAPPING, MAPPINGS
from chromadock.errors import ChromadockError
from chromadock.processors import processors
from chromadock.text import plural

_SECONDS = 10.0
_MOST_FRAMES = 1_000_000
_MOST_FPS = 240.0
_MOST_WORKERS = 256


def simulate(
    scene: Annotated[
        str,
        typer.Argument(
            metavar="SCENE",
            help="A scene that is shipped (pool, lake, sea) or a TOML file laid out like it.",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path, typer.Option(help="A new folder for pictures, or a .mp4.", show_default=False)
    ],
    frames: Annotated[
        int | None, typer.Option(help="Number of frames.", show_default="--seconds times --fps")
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(help="Length of the simulated time.", show_default="10")
    ] = None,
    fps: Annotated[float, typer.Option(help="Frames a second.")] = 15.0,
    seed: Annotated[
        int | None,
        typer.Option(help="Of waves, motion and noise.", show_default="the scene's"),
    ] = None,
    background: Annotated[
        Path | None,
        typer.Option(help="Folder of photographs instead of rendered water.", show_default=False),
    ] = None,
    mapping: Annotated[
        str, typer.Option(help=f"From water to marker colour: {', '.join(MAPPINGS)}.")
    ] = DEFAULT_MAPPING,
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="A key of the scene, e.g. vehicle.distance_m=5; may be repeated.",
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers",
            "--jobs",
            help="Processes of this machine; --jobs is its older name.",
            show_default="one a core",
        ),
    ] = None,
) -> None:
    """Simulate a dock and a vehicle in SCENE, and write what the vehicle sees.

    The dock's colour comes from its firmware, which looks at the water through a
    camera of its own.  Beside the frames stand truth.jsonl, a line a frame, and
    camera.yaml for `chromadock detect --camera`.
    """
    from rich.console import Console
    from rich.progress import track

    try:
        from chromadock.sim.photograph import Photographs
        from chromadock.sim.recording import open_recording
        from chromadock.sim.scene import load_scene
        from chromadock.sim.simulation import Simulation
        from chromadock.sim.workers import rendered
        from chromadock.toml_file import change
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"the simulator needs the package {error.name}: "
            "run `make setup` in the project's folder"
        ) from None
    count = _count(frames, seconds, fps)
    processes = _processes(workers)
    changes = dict(change(text, "vehicle.distance_m=5") for text in set_ or [])
    if seed is not None:
        changes["seed"] = seed
    photographs = None if background is None else Photographs(background)
    simulation = Simulation(load_scene(scene, changes), mapping, photographs)
    times = (index / fps for index in range(count))
    with open_recording(out, simulation.scene.vehicle_camera, fps) as recording:
        made = rendered(simulation, simulation.steps(times), processes, recording.finish)
        bar = track(
            made,
            "simulating",
            count,
            console=Console(stderr=True),
            transient=True,
            disable=not sys.stderr.isatty(),
        )
        for frame in bar:
            recording.write(frame)
    print(f"wrote {plural(count, 'frame')} to {out}")


def _count(frames: int | None, seconds: float | None, fps: float) -> int:
    """The number of frames."""
    if not 0 < fps <= _MOST_FPS:
        raise ChromadockError(f"--fps is {fps:g}: give frames a second, above 0 .. {_MOST_FPS:g}")
    if frames is not None and seconds is not None:
        raise ChromadockError("--frames and --seconds are both given: give one of them")
    given, wanted = f"--frames is {frames}", frames or 0.0
    if frames is None:
        seconds = _SECONDS if seconds is None else seconds
        given, wanted = f"--seconds is {seconds:g}", seconds * fps
    if not 1 <= wanted <= _MOST_FRAMES:
        raise ChromadockError(f"{given}: give 1 to {_MOST_FRAMES} frames")
    return round(wanted)


def _processes(workers: int | None) -> int:
    if workers is None:
        return processors()
    if not 1 <= workers <= _MOST_WORKERS:
        raise ChromadockError(f"--workers is {workers}: give 1 to {_MOST_WORKERS} processes")
    return workers
