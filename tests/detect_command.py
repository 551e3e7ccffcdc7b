"""``chromadock detect`` as the user runs it, for the tests of ``host/detect``.

``detect`` is a process of its own, for where OpenCV or FFmpeg might complain too, where the command
is stopped, or where it writes to a terminal.  The fixture ``detect_here`` runs it in the tests'
process, which is far quicker, where it is our line that counts.
"""

import subprocess
import sys

import numpy as np
from patience import PATIENCE_S

COMMAND = [sys.executable, "-m", "chromadock", "detect"]

CAMERA = """\
image_width: {width}
image_height: {height}
camera_matrix: {{rows: 3, cols: 3, data: [{f}, 0, 320, 0, {f}, 240, 0, 0, 1]}}
distortion_model: plumb_bob
distortion_coefficients: {{rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}}
"""

WATER = (200, 160, 40)  # BGR


def detect(*arguments, cwd):
    return subprocess.run(
        [*COMMAND, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )


def listed(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*"))


def refused(done, *says):
    """Exit status 2, and one line that names the thing and the mend."""
    assert done.returncode == 2, done.stderr
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("chromadock: error: ")
    assert "Traceback" not in done.stderr
    for words in says:
        assert words in lines[0]


def water(width=640, height=480):
    """A plain blue frame, BGR."""
    return np.full((height, width, 3), WATER, np.uint8)
