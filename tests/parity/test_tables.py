"""C, numpy and OpenCV agree on every colour there is."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = Path(__file__).with_name("all_colours.py")
OPENCV_4 = ROOT / "build" / "opencv4"


@pytest.mark.parametrize("hue_range", [180, 256, 1536])
@pytest.mark.parametrize("major", ["4", "5"])
def test_all_colours_agree(major: str, hue_range: int) -> None:
    environment = dict(os.environ)
    if major == "4":
        assert OPENCV_4.is_dir(), "OpenCV 4 is missing; run `make setup`"
        environment["PYTHONPATH"] = str(OPENCV_4)
    run = subprocess.run(
        [sys.executable, str(SCRIPT), str(hue_range)],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    version, compared, different = run.stdout.split()
    assert version.startswith(f"{major}.")
    assert (int(compared), int(different)) == (1 << 24, 0)
