"""The recordings that a run makes, to be fetched over HTTP."""

from __future__ import annotations

import re
from pathlib import Path

from chromadock.output.run_setup import RunSetup
from chromadock.vehicle.building import outputs_of


def recordings(setup: RunSetup | None) -> dict[str, Path]:
    """By name: the files that the run's settings name for recordings, with those of earlier runs,
    ``dive.mcap``, ``dive-2.mcap`` and so on.  No other file can be fetched."""
    found: dict[str, Path] = {}
    for text in [] if setup is None else outputs_of(setup.settings):
        kind, _, place = text.partition(":")
        if kind != "mcap":
            continue
        named = Path(place)
        numbered = re.compile(rf"{re.escape(named.stem)}(-\d+)?{re.escape(named.suffix)}")
        folder = named.resolve().parent
        for path in folder.iterdir() if folder.is_dir() else ():
            if numbered.fullmatch(path.name) and path.is_file():
                found[path.name] = path
    return dict(sorted(found.items()))
