#!/usr/bin/env python3
"""Choose the marker's hue for water of every hue: the mapping ``contrast``.

    .venv/bin/python shared/contrast.py            write shared/contrast.toml
    .venv/bin/python shared/contrast.py --check    write nothing; exit 1 if it would differ

It takes a simulation of some thousand views of water (``detectability``) and so the host's
package; ``generate.py``, which makes tables of the result for dock and vehicle, does not.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from detectability import Views, simulated_views
from generate import load
from numpy.typing import NDArray

from chromadock import method

FILE = Path(__file__).with_name("contrast.toml")

MOST_TURN = 0.5
"""Of the marker's hue for a turn of the water's by 1.  Dock and vehicle see the water in
slightly different colours: by at least half of that difference their markers' then agree."""

ROUGHNESS = 1e-4
"""Cost of a turn by one candidate between two nodes, squared, in ln(range): far below what any
water's range depends on, so that it only decides where that says nothing."""

LEAST_VIEWS = 20
"""A node with less weight of views than this knows nothing of its own."""

Floats = NDArray[np.float64]


def main() -> int:
    """Write or check; the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing, exit 1 on any drift")
    check = parser.parse_args().check
    text = document(chosen(load("method.toml")["marker"]["nodes"]))
    if FILE.exists() and FILE.read_text(encoding="utf-8") == text:
        return 0
    if check:
        print(f"{FILE.name}: differs; run `make contrast`", file=sys.stderr)
        return 1
    scratch = FILE.with_suffix(".new")
    scratch.write_text(text, encoding="utf-8")
    scratch.replace(FILE)
    print(f"wrote {FILE.name}; now run `make generate`")
    return 0


def document(hues: NDArray[np.int64]) -> str:
    """``contrast.toml``."""
    listed = "".join(
        f"    {', '.join(str(h) for h in hues[i : i + 12])},\n" for i in range(0, len(hues), 12)
    )
    return (
        "# Written by shared/contrast.py. Do not edit.\n"
        "# The marker's hue 0..1535 for water of hues evenly spaced from red; docs/method.md.\n"
        f"hues = [\n{listed}]\n"
    )


def chosen(nodes: int) -> NDArray[np.int64]:
    """(nodes,) hues 0..1535 of the marker for water of hues evenly spaced from red.

    Those with the largest mean ln(range) over all nodes, of all that turn by MOST_TURN at most.
    """
    step = round(method.HUE_RANGE / nodes * MOST_TURN)
    candidates = np.arange(0, method.HUE_RANGE, step)
    score = scores(simulated_views(candidates), nodes)
    return np.asarray(candidates[smoothest(score)])


def scores(views: Views, nodes: int) -> Floats:
    """(nodes, H) mean of ln(range) at each node, 0 for all where nothing looks like it.

    Each view counts for the two nodes beside its hue, once as the vehicle's camera sees it and
    once as the dock's does.
    """
    place = views.hue.ravel() * nodes / method.HUE_RANGE
    below = np.floor(place).astype(int)
    above = place - below
    log_range = np.log(views.range_m).repeat(2, axis=0)
    weight, total = np.zeros(nodes), np.zeros((nodes, log_range.shape[1]))
    for node, share in ((below, 1 - above), ((below + 1) % nodes, above)):
        np.add.at(weight, node, share)
        np.add.at(total, node, share[:, None] * log_range)
    known = weight >= LEAST_VIEWS
    total[known] /= weight[known, None]
    total[~known] = 0
    return total


def smoothest(score: Floats) -> NDArray[np.intp]:
    """(nodes,) candidates of the best closed way round, neighbours at most one candidate apart.

    Bellman's dynamic programming, from every candidate at the first node back to itself.
    """
    nodes, count = score.shape
    best = np.full((count, count), -np.inf)  # from each first candidate to each present one
    np.fill_diagonal(best, score[0])
    moves = []
    for node in range(1, nodes + 1):
        # Present candidate c came from c + 1, c or c - 1.
        ways = np.stack([np.roll(best, -1, 1) - ROUGHNESS, best, np.roll(best, 1, 1) - ROUGHNESS])
        moves.append(ways.argmax(axis=0))
        best = ways.max(axis=0) + (score[node] if node < nodes else 0.0)
    first = int(np.diagonal(best).argmax())
    way = [first]
    for move in reversed(moves):
        way.append((way[-1] + 1 - int(move[first, way[-1]])) % count)
    return np.array(way[:0:-1])


if __name__ == "__main__":
    sys.exit(main())
