"""How often the dock is found, how often elsewhere than it is, and how often where none is.

.venv/bin/python tools/recall.py [--frames N] [--seed N] [--half develop|report] [--jobs N]
    [--distances 0.7 1 ...] [--fixed camera=hd ...] [--photographs FOLDER ...]
    [--save FOLDER] [--json FILE] [--scenes variety|old]

Scenes are drawn by chromadock.variety; the same seed makes the same ones.  A dock is recalled
if every marker is within 3 pixels or 0.5 % of the width, whichever is more, and its place within
5 % of the range; wrong is a dock that is found with its place off by more.  ``limit`` is the
share of frames in which every marker stands out of the noise at its true place, by the light of
its lamp alone.  False docks are counted in scenes that show lamps and no dock, and on the
photographs of --photographs, each for each mapping, as it is and as JPEG once more.
``--scenes old`` prints the older composites' table.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path

import recall_old
from fixed import fixed_factors
from recall_tables import Row, by_distance, by_factors
from recall_trials import photograph_trial, scene_trial
from step import ROOT

from chromadock.choices import DEFAULT_METHOD, METHODS
from chromadock.errors import ChromadockError
from chromadock.variety import Backdrops, Half
from chromadock.variety.factors import variety

BACKGROUNDS = ROOT.parent / "shared" / "data" / "transdec" / "backgrounds"
FRAMES = 100
NO_DOCK_SHARE = 0.5
"""Scenes without a dock for each with one at a single distance."""


def main() -> int:
    """Print the tables; exit status 2 for a wrong option, 3 without photographs."""
    args = _arguments()
    if args.scenes == "old":
        distances = [float(d) for d in args.distances] if args.distances else None
        return recall_old.main(args.method, args.frames, args.seed, args.jobs, distances)
    try:
        rows, empty, looks = _run(args)
    except ChromadockError as error:
        print(error, file=sys.stderr)
        return 2
    if rows:
        print(f"method {args.method}, half {args.half}, seed {args.seed}")
        print("\n".join([*by_distance(rows), *by_factors(rows), ""]))
    wrong = sum(r["found"] for r in empty)
    print(f"false docks: {wrong} in {len(empty)} scenes of lamps without a dock")
    for quality in sorted({r["jpeg_quality"] for r in looks}, key=lambda q: q or 101):
        here = [r for r in looks if r["jpeg_quality"] == quality]
        found = sorted({f"{r['photograph']} ({r['mapping']})" for r in here if r["found"]})
        way = "as they are" if quality is None else f"as JPEG {quality}"
        print(f"             {len(found)} in {len(here)} looks at photographs {way}")
        print("".join(f"               {name}\n" for name in found), end="")
    if args.json:
        lines = "".join(json.dumps(row) + "\n" for row in (*rows, *empty, *looks))
        args.json.write_text(lines, encoding="utf-8")
    return 0


def _run(args: argparse.Namespace) -> tuple[list[Row], list[Row], list[Row]]:
    """Scenes with a dock, those without one, and the photographs."""
    half = Half(args.half)
    fixed = fixed_factors(args.fixed)
    backdrops = Backdrops.of_folders(BACKGROUNDS, args.photographs).half(half)
    if args.save:
        args.save.mkdir(parents=True, exist_ok=True)
    distances: Sequence[str] = args.distances or tuple(variety().shares["distance"])
    count = FRAMES if args.frames is None else args.frames
    empty = int(NO_DOCK_SHARE * count) if args.no_dock is None else args.no_dock
    seed = half.seed(args.seed)
    with ProcessPoolExecutor(args.jobs) as pool:
        # An index is a scene's own, so that distances do not share their backdrops.
        scenes = [
            pool.submit(
                scene_trial,
                args.method,
                100_000 * n + i,
                seed,
                backdrops,
                {"distance": distance, **fixed},
                args.save,
            )
            for (n, distance), i in product(enumerate(distances), range(count))
        ]
        none = [
            pool.submit(
                scene_trial, args.method, i, seed, backdrops, {**fixed, "dock": "none"}, args.save
            )
            for i in range(10_000_000, 10_000_000 + empty)
        ]
        files = backdrops.other
        every = len(files) if args.looks is None else max(args.looks, 1)
        files = files[:: max(len(files) // max(every, 1), 1)]
        looks = [pool.submit(photograph_trial, args.method, path) for path in files]
        return (
            [job.result() for job in scenes],
            [job.result() for job in none],
            [row for job in looks for row in job.result()],
        )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", choices=("variety", "old"), default="variety")
    parser.add_argument("--method", choices=METHODS, default=DEFAULT_METHOD)
    parser.add_argument("--frames", type=int, help="a distance")
    parser.add_argument("--no-dock", type=int, metavar="N", help="scenes without a dock")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--half", choices=[h.value for h in Half], default=Half.DEVELOP.value)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--distances", nargs="*", help="metres, of the original dock")
    parser.add_argument("--fixed", nargs="*", default=(), metavar="FACTOR=VALUE")
    parser.add_argument("--photographs", nargs="*", type=Path, default=(), metavar="FOLDER")
    parser.add_argument("--looks", type=int, metavar="N", help="at most so many photographs")
    parser.add_argument("--save", type=Path, metavar="FOLDER", help="pictures of what went wrong")
    parser.add_argument("--json", type=Path, metavar="FILE", help="one line a scene")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
