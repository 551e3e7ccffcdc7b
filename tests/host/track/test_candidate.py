"""How many markers a candidate's frames must show for a lock within tenths of a second."""

from __future__ import annotations

import numpy as np
import pytest
from robust_composites import CAMERA
from track_truth import rotation

from chromadock.geometry.pose import Sighting, estimates
from chromadock.track.candidate import LOCK_EVIDENCE, LOCK_FRAMES, Candidate
from chromadock.track.sight import Sight
from chromadock.variety.docks import dock_geometry


def sight(name: str, seen: int, rng: np.random.Generator) -> Sight:
    """The first ``seen`` markers of a dock 3 m away."""
    dock = dock_geometry(name, 0.89)
    places = dock.points[:seen] @ rotation(2, 15, 1).T + [0.2, 0.1, 3.0]
    pixels = CAMERA.project(places) + rng.normal(0, 0.1, (seen, 2))
    poses = estimates(Sighting(dock.points[:seen], pixels, np.full(seen, 0.1), CAMERA))
    markers = {n: (x, y) for n, (x, y) in zip(dock.names, pixels.tolist(), strict=False)}
    found = Sight.of(markers, [0.1] * seen, poses, dock, CAMERA)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("name", "seen", "locked"),
    [
        ("ring", 8, True),
        ("ring", 7, True),
        ("five", 4, True),
        ("rectangle", 4, True),
        ("rectangle", 3, False),
        ("three", 3, True),
    ],
)
def test_three_frames_of_four_markers_or_a_whole_dock_lock(
    name: str, seen: int, locked: bool
) -> None:
    rng = np.random.default_rng(seen)
    candidate = Candidate.of(sight(name, seen, rng), LOCK_EVIDENCE, 0.0)
    for k in range(1, LOCK_FRAMES):
        assert not candidate.locked(rival=False)
        after = candidate.looked_for().seen(sight(name, seen, rng), LOCK_EVIDENCE, k / 10)
        assert after is not None
        candidate = after
    assert candidate.locked(rival=False) is locked
