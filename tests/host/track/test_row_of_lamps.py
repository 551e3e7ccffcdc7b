"""A row of lamps: what looks like the dock beside it, by three of its lamps and a stranger."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from track_truth import CAMERA

from chromadock import Track, Tracker
from chromadock.geometry.pose import Sighting, estimates
from chromadock.look import Found
from chromadock.variety.docks import dock_geometry

HZ = 10


class Row:
    """A dock of four lamps in line, of which the last three and a stranger look just like it."""

    def __init__(self) -> None:
        self.dock = dock_geometry("line", 0.9)
        self.tracker, self.rng = Tracker(self.dock), np.random.default_rng(1)
        self.t = np.array([-0.4, 0.1, 4.0])

    def look(self, time_s: float, evidence: float, aside_m: float = 0.0) -> Track:
        """At all of the frame, where the dock is found at its place or ``aside_m`` of it."""
        place = self.t + np.array([aside_m, 0.0, 0.0])
        xy = CAMERA.project(self.dock.points + place) + self.rng.normal(0, 0.01, (4, 2))
        poses = estimates(Sighting(self.dock.points, xy, np.full(4, 0.3), CAMERA))
        places = {n: (float(u), float(v)) for n, (u, v) in zip(self.dock.names, xy, strict=True)}
        what = Found("found", 0.0, (), places, poses[0].pose(), poses, evidence)
        what = replace(what, sigma_px=(0.3,) * 4)
        plan = replace(self.tracker.plan(time_s), priors=(), everywhere=True)
        return self.tracker.update(time_s, plan, what, CAMERA)

    def off_m(self, track: Track) -> float:
        """Metres from the dock's place."""
        assert track.pose is not None
        return float(np.linalg.norm(np.subtract(track.pose.t, self.t)))


def test_a_row_of_lamps_with_one_more_at_its_end_does_not_move_the_dock() -> None:
    row = Row()
    tracks = [row.look(k / HZ, 20.0) for k in range(12)]
    assert tracks[-1].pose is not None
    assert row.off_m(row.look(1.2, 8.0, aside_m=0.3)) < 0.1


def test_nor_does_it_move_a_dock_that_is_not_locked_yet() -> None:
    row = Row()
    row.look(0.0, 20.0)
    for k in (1, 2, 3):
        row.look(k / HZ, 8.0, aside_m=0.3)
        [candidate] = row.tracker._memory.candidates
        assert candidate.frames == 1
    tracks = [row.look(k / HZ, 20.0) for k in range(4, 12)]
    assert row.off_m(tracks[-1]) < 0.1


def test_of_two_such_docks_the_one_with_more_evidence_is_locked() -> None:
    row = Row()
    for k in range(3):
        row.look(k / HZ, 8.0, aside_m=0.3)
    tracks = [row.look(k / HZ, 20.0) for k in range(4, 20)]
    assert row.off_m(tracks[-1]) < 0.1
