"""What the command line says of lamps that are too bright, and how often."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock import Detection
from chromadock.cli.report import _COMPARED_FRAMES, Report
from chromadock.results.detection import Background, Marker
from chromadock.sources.base import Frame

FRAME = Frame(np.zeros((8, 8, 3), np.uint8), "frame", 0, 0.0)


def said(stops_over: float, clipped: float, frames: int, capsys: pytest.CaptureFixture[str]) -> str:
    """Standard error after so many frames alike."""
    water, marker = Background((40, 160, 200), 195.0, 1.0), Marker((255, 0, 0), 0.0)
    seen = Detection("found", water, marker, None, 0.0, clipped=clipped, stops_over=stops_over)
    report = Report(json=True, calibrated=True)
    for _ in range(frames):
        report.frame(FRAME, seen)
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("stops_over", "words"),
    [(0.2, "about 1 stop (to 1/2)"), (1.6, "about 2 stops (to 1/4)"), (8.0, "8 stops (to 1/256)")],
)
def test_how_much_shorter_to_expose_is_said_once(
    stops_over: float, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    err = said(stops_over, 0.75, 3 * _COMPARED_FRAMES, capsys)
    assert err.count("warning: most lamps are overexposed") == 1
    assert words in err


def test_a_few_frames_or_a_single_lamp_deserve_no_word(capsys: pytest.CaptureFixture[str]) -> None:
    assert said(2.0, 0.75, _COMPARED_FRAMES - 1, capsys) == ""
    assert said(2.0, 0.25, 3 * _COMPARED_FRAMES, capsys) == ""


def test_that_only_the_holders_of_the_lamps_show_is_said_once(
    capsys: pytest.CaptureFixture[str],
) -> None:
    water, marker = Background((40, 160, 200), 195.0, 1.0), Marker((255, 0, 0), 0.0)
    report = Report(json=True, calibrated=True)
    for _ in range(3 * _COMPARED_FRAMES):
        report.frame(FRAME, Detection("found", water, marker, None, 0.0, evidence=8.0))
        # A method that weighs no evidence knows nothing of it.
        report.frame(FRAME, Detection("found", water, marker, None, 0.0))
    err = capsys.readouterr().err
    assert err.count("found by the dark holders of its lamps") == 1
