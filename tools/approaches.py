"""Drawn approaches through the detector with its track: when it locks, and how right it is.

.venv/bin/python tools/approaches.py [--runs N] [--no-dock N] [--attitude both|with|without]
    [--seed N] [--half develop|report] [--jobs N] [--fixed camera=hd ...] [--first N]
    [--plain FOLDER] [--photographs FOLDER ...] [--still FOLDER ...] [--stills N]
    [--save FOLDER] [--json FILE]

Each run is an approach of chromadock.variety, 14 s at 10 frames/s from 7 m to 0.7 m (of a dock as
wide as the original), seen once with the vehicle's attitude as its telemetry has it and once
without.  ``tracked``: of the frames nearer than 5 m that show all markers.  ``wrong``: frames in
which the track has a pose whose place is off by more than 5 % of the range; ``worst``: by how
much.  ``covered``: of the tracked frames those with the truth in the 95 % region of the pose or
its alternative.  ``found`` and the second ``wrong`` are the single frames', of which those of a
tracked dock are mostly looked at where it is expected.  In approaches to no dock, and before
photographs held by --still, nothing may lock.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from itertools import product
from pathlib import Path
from typing import Any

from approaches_runs import Row, run_trial, still_trial
from approaches_tables import RUN, by_run, in_sum, of_no_dock, of_photographs
from fixed import fixed_factors
from step import ROOT

from chromadock.choices import MAPPINGS
from chromadock.errors import ChromadockError
from chromadock.variety import Backdrops, Half
from chromadock.variety.backdrops import pictures_in

PLAIN = ROOT.parent / "shared" / "data" / "transdec" / "backgrounds"
WAYS = {"both": (False, True), "with": (True,), "without": (False,)}
NO_DOCK_FROM = 10_000_000
"""Their indices: no other run has the same water."""


def main() -> int:
    """Print the tables; exit status 2 for a wrong option, 1 where a dock is locked without one."""
    args = _arguments()
    print(f"half {args.half}, seed {args.seed}\n{RUN}", flush=True)
    try:
        rows, empty, held = _run(args)
    except ChromadockError as error:
        print(error, file=sys.stderr)
        return 2
    if rows:
        print("\n".join(["", *in_sum(rows), ""]))
    if empty:
        print("\n".join(of_no_dock(empty)))
    if held:
        print("\n".join(of_photographs(held)))
    if args.json:
        lines = "".join(json.dumps(_plain(row)) + "\n" for row in (*rows, *empty, *held))
        args.json.write_text(lines, encoding="utf-8")
    return int(any(r["posed"] for r in empty) or any(r["locked"] for r in held))


def _run(args: argparse.Namespace) -> tuple[list[Row], list[Row], list[Row]]:
    """Approaches to a dock, those to none, and photographs that are held."""
    half, fixed = Half(args.half), fixed_factors(args.fixed)
    backdrops = Backdrops.of_folders(args.plain, args.photographs).half(half)
    if args.save:
        args.save.mkdir(parents=True, exist_ok=True)
    seed, ways = half.seed(args.seed), WAYS[args.attitude]
    stills = [p for p in pictures_in(args.still) if half.has(p)]
    if args.stills:
        stills = stills[:: max(len(stills) // args.stills, 1)][: args.stills]
    empty = args.runs // 4 if args.no_dock is None else args.no_dock
    with ProcessPoolExecutor(args.jobs) as pool:
        runs = [
            pool.submit(run_trial, i, seed, backdrops, fixed, ways, args.save)
            for i in range(args.first, args.first + args.runs)
        ]
        none = [
            pool.submit(run_trial, i, seed, backdrops, {**fixed, "dock": "none"}, ways, args.save)
            for i in range(NO_DOCK_FROM + args.first, NO_DOCK_FROM + args.first + empty)
        ]
        held = [pool.submit(still_trial, p, m) for p, m in product(stills, MAPPINGS)]
        return (
            _told(runs),
            [row for job in none for row in job.result()],
            [job.result() for job in held],
        )


def _told(jobs: Sequence[Future[list[Row]]]) -> list[Row]:
    """Their rows, each printed as soon as it and all before it are there."""
    rows: list[Row] = []
    for job in jobs:
        rows += job.result()
        print("\n".join(by_run(job.result())), flush=True)
    return rows


def _plain(value: Any) -> Any:
    """The same with null for numbers that JSON does not have."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, list):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--first", type=int, default=0, metavar="N", help="index of the first run")
    parser.add_argument("--no-dock", type=int, metavar="N", help="a quarter of the runs")
    parser.add_argument("--attitude", choices=tuple(WAYS), default="both")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--half", choices=[h.value for h in Half], default=Half.DEVELOP.value)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--fixed", nargs="*", default=(), metavar="FACTOR=VALUE")
    parser.add_argument("--plain", type=Path, default=PLAIN, metavar="FOLDER", help="water alone")
    parser.add_argument("--photographs", nargs="*", type=Path, default=(), metavar="FOLDER")
    parser.add_argument("--still", nargs="*", type=Path, default=(), metavar="FOLDER")
    parser.add_argument("--stills", type=int, metavar="N", help="at most so many photographs")
    parser.add_argument("--save", type=Path, metavar="FOLDER", help="pictures of what went wrong")
    parser.add_argument("--json", type=Path, metavar="FILE", help="one line a run and way")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
