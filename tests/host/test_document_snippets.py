"""Every piece of Python in the documents runs, with what its reader is taken to have."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from autopilot_peer import free_port
from document_commands import DOCUMENTS, blocks
from filmed_approach import CAMERA, CAMERA_YAML, frames

from chromadock import Attitude, Detector, DockGeometry
from chromadock.mounting import R_BODY_CAMERA_FORWARD, Mounting

SHORTER = {
    "0.0.0.0:14555": "127.0.0.1:{port}",  # may be taken
    "    ...  # moment": "    break  # moment",  # half a minute of frames
}


def pieces(document: Path) -> list[str]:
    """In their order: a later one goes on with the names of those before."""
    found = ["\n".join(lines) for language, lines in blocks(document) if language == "python"]
    for shown, run in SHORTER.items():
        found = [piece.replace(shown, run.format(port=free_port())) for piece in found]
    return found


def given() -> dict[str, Any]:
    """Names that a piece may take for known."""
    pictures = frames(3)
    detector = Detector(CAMERA, DockGeometry.default())
    detector.process(pictures[0].image, pictures[0].time_s)
    return {
        "time": time,
        "frames": [(frame.image, frame.time_s) for frame in pictures],
        "frame_bgr": pictures[1].image,
        "time_s": pictures[1].time_s,
        "rgb565_bytes": bytes(2 * 160 * 120),
        "camera": CAMERA,
        "dock": DockGeometry.default(),
        "detector": detector,
        "mounting": Mounting(R_body_camera=R_BODY_CAMERA_FORWARD),
        "attitude": Attitude(0.0, 0.0, 0.0),
        "roll": 0.0,
        "pitch": 0.0,
        "yaw": 0.0,
        "R_body_camera": R_BODY_CAMERA_FORWARD,
        "R_level_dock": np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
    }


def files(folder: Path) -> None:
    """Those that a piece opens."""
    (folder / "cam.yaml").write_text(CAMERA_YAML)
    for name, level in (("plain_water", 110), ("anything_under_water", 90)):
        (folder / name).mkdir()
        for number in range(8):
            noise = np.random.default_rng(number).normal(0, 5, (480, 640, 3))
            water = np.clip(np.array((150, level, 40)) + noise, 0, 255).astype(np.uint8)
            cv2.imwrite(str(folder / name / f"{number}.png"), water)


@pytest.mark.parametrize(
    "document", [d for d in DOCUMENTS if pieces(d)], ids=lambda path: path.name
)
def test_the_python_of_a_document_runs(
    document: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files(tmp_path)
    monkeypatch.chdir(tmp_path)
    names = given()
    for piece in pieces(document):
        exec(compile(piece, document.name, "exec"), names)


def test_what_is_shortened_stands_in_a_document() -> None:
    shown = "".join(document.read_text() for document in DOCUMENTS)
    assert all(part in shown for part in SHORTER)
