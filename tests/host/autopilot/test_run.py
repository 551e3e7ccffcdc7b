"""The whole way: a web camera sees a dock, and an autopilot is told where it is."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from autopilot_peer import SYSTEM, free_port, udp_peer
from patience import PATIENCE_S
from pymavlink.dialects.v20 import common as mavlink
from robust_composites import compose
from web_camera import RANGE_M, WATER_BGR, dock_frames, same, web_camera


@pytest.fixture(scope="module")
def camera() -> Iterator[str]:
    with web_camera() as url:
        yield url


def test_a_vehicles_autopilot_is_told_where_the_dock_is(camera: str, tmp_path: Path) -> None:
    port = free_port()
    (tmp_path / "v.toml").write_text(
        f'[camera]\nsource = "{camera}"\n[outputs]\n'
        f'results = ["mavlink:udpin:127.0.0.1:{port}?receiver=ardupilot-rover&vision=on"]\n'
    )
    peer, end = udp_peer(port, mavlink.MAV_TYPE_SURFACE_BOAT)
    command = [sys.executable, "-m", "chromadock", "run", "v.toml", "--json"]
    with (
        end,
        subprocess.Popen(
            command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        ) as run,
    ):
        peer.until(lambda: len(peer.named("LANDING_TARGET")) > 5)
        run.send_signal(signal.SIGINT)
        assert run.stderr is not None
        said = run.stderr.read()
    target = peer.named("LANDING_TARGET")[-1]
    assert (target.get_srcSystem(), target.get_srcComponent()) == (SYSTEM, 191)
    assert target.z == pytest.approx(RANGE_M, rel=0.05)  # ahead, as a Rover reads it
    assert target.distance == pytest.approx(np.hypot(np.hypot(target.x, target.y), target.z))
    assert target.position_valid == 1
    vision = peer.named("VISION_POSITION_ESTIMATE")[-1]
    assert np.linalg.norm([vision.x, vision.y, vision.z]) == pytest.approx(RANGE_M, rel=0.05)
    assert any("dock locked, 2." in text.text for text in peer.named("STATUSTEXT"))
    # Stamped with the capture: later ones are later, and none is of the future.
    stamps = [message.time_usec for message in peer.named("LANDING_TARGET")]
    assert (np.diff(stamps) > 0).all()
    assert run.returncode == 130 and "age of the picture" in said and "Traceback" not in said


def test_a_dry_run_says_what_the_autopilot_would_understand(tmp_path: Path) -> None:
    for k, jpeg in enumerate(dock_frames(8)):
        (tmp_path / f"{k}.jpg").write_bytes(jpeg)
    command = [
        *(sys.executable, "-m", "chromadock", "detect", str(tmp_path), "--fps", "10"),
        *("--dry-run", "--out", "mavlink:udpin:0.0.0.0:14555?receiver=ardupilot-rover"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    lines = [line for line in done.stderr.splitlines() if "LANDING_TARGET" in line]
    assert len(lines) == 1  # of less than a second
    x, y, z = compose(np.full((480, 640, 3), WATER_BGR, np.uint8), RANGE_M, same()).t
    assert x < 0 and y < 0  # left, above: the camera looks ahead
    assert f"dock {z:.1f} m ahead, {-x:.1f} m left, {-y:.1f} m above" in lines[0]
