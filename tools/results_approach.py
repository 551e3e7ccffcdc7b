"""Runs the approaches and makes their section of docs/results.md.

By itself it runs them and prints the section: ``python tools/results_approach.py``.
"""

from __future__ import annotations

from pathlib import Path

import polars as pl
from approach import SCENARIOS, read_approaches, run_all
from approach_plot import approach_plot
from approach_tables import OFF_M, OFF_SHARE, summaries
from jinja2 import FileSystemLoader

from chromadock.errors import ChromadockError
from chromadock.evaluate.drawings import Drawing
from chromadock.evaluate.rendering import environment
from chromadock.evaluate.store import write_whole
from chromadock.evaluate.style import svg

ROWS = "approach.parquet"
"""The frames, in the folder of the results."""


def run_approaches(out: Path) -> pl.DataFrame:
    """Run all and leave the frames in the folder ``out``."""
    frames = run_all(read_approaches(SCENARIOS))
    out.mkdir(parents=True, exist_ok=True)
    partial = out / f".partial-{ROWS}"
    frames.write_parquet(partial)
    partial.replace(out / ROWS)
    return frames


def read_frames(out: Path) -> pl.DataFrame | None:
    """The frames that ``run_approaches`` left there, if it did."""
    path = out / ROWS
    return pl.read_parquet(path) if path.exists() else None


def approach_drawing(frames: pl.DataFrame) -> Drawing:
    """The figure."""
    return Drawing(
        "approach",
        "The state of the track on each approach",
        "A bar a run; time below, the range at which the vehicle is then above.",
        frames,
        svg(approach_plot(frames), "approach"),
    )


def approach_section(frames: pl.DataFrame) -> str:
    """The text."""
    drawing = approach_drawing(frames)
    found = summaries(frames)
    times = frames["time_s"].unique().sort()
    template = environment(FileSystemLoader(Path(__file__).parent), markup=False)
    return template.get_template("approach.md.jinja").render(
        summaries=found,
        missed=[it for it in found if it.lock_s is None],
        seconds=times[-1],
        rate_hz=round(1 / (times[1] - times[0]), 3),
        from_m=round(frames["range_m"].max(), 1),
        to_m=round(frames["range_m"].min(), 1),
        frames=frames.height,
        off=f"{100 * OFF_SHARE:g} % of the range and {100 * OFF_M:g} cm",
        title=drawing.title,
        caption=drawing.caption,
        moment=_moment,
        share=_share,
        angle=_angle,
    )


def _moment(time_s: float | None, range_m: float | None) -> str:
    return "–" if time_s is None else f"{time_s:.1f} s, {range_m:.2f} m"


def _share(value: float | None, digits: int = 0) -> str:
    return "–" if value is None else f"{100 * value:.{digits}f} %"


def _angle(value: float | None) -> str:
    return "–" if value is None else f"{value:.1f}°"


def main() -> int:
    """Run, print the section, leave the figure beside the frames; the exit status."""
    out = Path(__file__).resolve().parents[1] / "out" / "approach"
    try:
        frames = run_approaches(out)
    except ChromadockError as error:
        print(f"results: error: {error}")
        return 2
    write_whole(out / "approach.svg", approach_drawing(frames).svg.encode())
    print(approach_section(frames))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
