"""``chromadock demo``: the whole system in a closed loop, without hardware."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from chromadock.errors import ChromadockError
from chromadock.processors import processors

if TYPE_CHECKING:
    from chromadock.demo.record import Record

_ROWS = 13
_SNAPSHOTS = 3


def demo(
    out: Annotated[Path, typer.Option(help="Folder for the video, the page and the data.")] = Path(
        "out/demo"
    ),
) -> None:
    """Run dock and vehicle in simulated water: a blue pool, then a green lake."""
    import numpy as np
    from rich.console import Console
    from rich.progress import track

    from chromadock.output import JsonLines, open_overlay
    from chromadock.overlay import draw_overlay

    try:
        from chromadock.demo.loop import COUNT, FRAME_RATE_HZ, run
        from chromadock.demo.overview import write_overview
        from chromadock.demo.record import Record
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"the demo needs the package {error.name}: run `make demo` in the project's folder"
        ) from None
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ChromadockError(f"{out}: cannot be made a folder ({error.strerror})") from None

    shown = set(np.linspace(0, COUNT - 1, _SNAPSHOTS).astype(int).tolist())
    records, snapshots = [], []
    with ExitStack() as stack:
        video = stack.enter_context(open_overlay(out / "overlay.mp4", COUNT, FRAME_RATE_HZ))
        lines = stack.enter_context(JsonLines(out / "frames.jsonl"))
        moments = run(processors())
        console = Console(stderr=True)
        for moment in track(moments, "approaching", COUNT, console=console, transient=True):
            picture = draw_overlay(
                moment.frame.image_bgr,
                moment.mask,
                moment.detection,
                moment.scene.vehicle_camera.model,
                moment.scene.dock,
            )
            video.write(picture, "", moment.index)
            if moment.index in shown:
                snapshots.append((moment.time_s, picture))
            records.append(Record.of(moment))
            lines.write(records[-1].to_dict())
    write_overview(out / "overview.png", records, snapshots)
    _print_table(records)
    print(f"wrote {out / 'overlay.mp4'}, {out / 'overview.png'}, {out / 'frames.jsonl'}")


def _print_table(records: Sequence[Record]) -> None:
    """Poses against the truth; simulated."""
    import numpy as np
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Hue of water and markers; pose against the truth (simulated)")
    for heading in ("time", "water", "dock", "vehicle", "range", "measured", "error", "attitude"):
        table.add_column(heading, justify="right", no_wrap=True)
    for index in np.linspace(0, len(records) - 1, _ROWS).astype(int):
        r = records[index]
        water = r.detection.background.hue_deg
        table.add_row(
            f"{r.time_s:.1f} s",
            _or_dash(water, "{:.0f}°"),
            f"{r.dock_hue_deg:.0f}°",
            _or_dash(r.detection.marker.hue_deg, "{:.0f}°"),
            f"{r.true_range_m:.2f} m",
            _or_dash(r.range_m, "{:.2f} m"),
            _or_dash(r.position_error_m, "{:.3f} m"),
            _or_dash(r.attitude_error_deg, "{:.1f}°"),
        )
    Console().print(table)
    errors = [r.position_error_m for r in records if r.position_error_m is not None]
    median = f", median position error {np.median(errors):.3f} m" if errors else ""
    found = sum(r.detection.found for r in records)
    apart = max(r.hue_disagreement_deg for r in records)
    print(
        f"simulated: found in {found} of {len(records)} frames{median}; "
        f"dock and vehicle at most {apart:.1f}° of hue apart"
    )


def _or_dash(value: float | None, form: str) -> str:
    return "-" if value is None else form.format(value)
