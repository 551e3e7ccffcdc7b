"""What the tests of recordings share: a short dive, and its recording."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest
from filmed_approach import CAMERA, detected, frames
from recorded_dive import COUNT

from chromadock import Attitude
from chromadock.output.recording import Recording
from chromadock.output.run_setup import RunSetup
from chromadock.results.detection import Detection
from chromadock.sources import Frame
from chromadock.vehicle.keys import VehicleFile


@pytest.fixture(scope="module")
def run() -> tuple[list[Frame], list[Detection]]:
    """Of a vehicle that tells its attitude, another one with each frame."""
    pictures = [
        dataclasses.replace(frame, attitude=Attitude(0.01 * frame.index, 0.02, -0.5))
        for frame in frames(COUNT, start_s=3.0)
    ]
    results = detected(pictures)
    assert [r.track.state for r in results if r.track][-1] == "tracking"
    return pictures, results


@pytest.fixture(scope="module")
def recorded(
    run: tuple[list[Frame], list[Detection]], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """As of a camera whose pictures were 40 ms old when their results were out."""
    path = tmp_path_factory.mktemp("recorded") / "dive.mcap"
    with Recording(path, RunSetup(VehicleFile(), CAMERA)) as recording:
        for frame, detection in zip(*run, strict=True):
            recording.write(frame, detection, 0.04)
    return path
