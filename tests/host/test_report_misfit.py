"""A dock file that does not fit is told once, and not for a frame now and then."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock import Detection
from chromadock.cli.report import Report
from chromadock.results.detection import Background, Marker, Misfit
from chromadock.sources.base import Frame

FRAME = Frame(np.zeros((8, 8, 3), np.uint8), "frame", 0, 0.0)
WATER, MARKER = Background((40, 160, 200), 195.0, 1.0), Marker((255, 0, 0), 0.0)


@pytest.mark.parametrize(("every", "times"), [(1, 1), (2, 1), (10, 0)])
def test_it_is_said_once_where_many_frames_do_not_fit(
    every: int, times: int, capsys: pytest.CaptureFixture[str]
) -> None:
    report = Report(json=True, calibrated=True)
    for k in range(200):
        amiss = None if k % every else Misfit(12.0, 0.8)
        places = {"a": (1.0, 2.0), "b": (3.0, 2.0), "c": (2.0, 4.0)}
        seen = Detection("found", WATER, MARKER, None, 0.0, markers=places, misfit=amiss)
        report.frame(FRAME, seen)
    said = capsys.readouterr().err
    assert said.count("warning: something stands like the dock") == times
    assert said.count("0.8 pixels off") == times
