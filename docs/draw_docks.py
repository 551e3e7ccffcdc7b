"""Draws docs/images/docks.svg from the two docks' geometry: `.venv/bin/python docs/draw_docks.py`.

Each dock from the front, as the vehicle sees it, and from above with what turning does to it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from draw_wiring import FAINT, IMAGES, INK, RED, SUPPLY, Drawing

from chromadock import DockGeometry

FIVE = Path(__file__).resolve().parent / "five_marker_dock.toml"
SCALE = 330  # SVG units a metre
RADIUS = 9
TURN_DEG = 20.0


def main() -> None:
    """Write the picture."""
    IMAGES.mkdir(exist_ok=True)
    draw().save(IMAGES / "docks.svg")


def draw() -> Drawing:
    """Both docks side by side."""
    drawing = Drawing(
        1000,
        620,
        "Where the markers are",
        "The rectangle and the five-marker dock, each from the front and from above.",
    )
    docks = (("rectangle", DockGeometry.default()), ("five markers", DockGeometry.from_toml(FIVE)))
    for (title, dock), x in zip(docks, (250, 750), strict=True):
        drawing.text(x, 88, title, size=19, anchor="middle", weight="bold")
        draw_front(drawing, dock.points, x, 180)
        draw_above(drawing, dock.points, x, 395)
    drawing.text(40, 130, "from the front", colour=FAINT, size=14)
    drawing.text(40, 300, "from above", colour=FAINT, size=14)
    drawing.text(
        40,
        598,
        f"Red: turned by {TURN_DEG:g}° to either side.  From afar the rectangle looks the same "
        "both times; the front marker moves to opposite sides.",
        size=14,
        colour=FAINT,
    )
    return drawing


def draw_front(drawing: Drawing, points: np.ndarray, x: float, y: float) -> None:
    """As the vehicle sees it: x right, y down; a marker in front is a ring about its dot."""
    at = points[:, :2] * SCALE + (x, y)
    (left, top), (right, bottom) = at.min(axis=0), at.max(axis=0)
    drawing.path(f"M{left:g} {top:g} H{right:g} V{bottom:g} H{left:g} z", FAINT, 2)
    for (px, py), depth in zip(at, points[:, 2], strict=True):
        drawing.path(circle(px, py, RADIUS), SUPPLY, 2, fill=SUPPLY)
        if depth < 0:
            drawing.path(circle(px, py, RADIUS + 6), SUPPLY, 2)
            drawing.text(px, py - 30, f"{-depth:g} m in front", size=14, anchor="middle")
    dimension(drawing, left, right, bottom + 36, f"{np.ptp(points[:, 0]):.3f} m")
    drawing.text(right + 18, y + 5, f"{np.ptp(points[:, 1]):.3f} m", size=14)


def draw_above(drawing: Drawing, points: np.ndarray, x: float, y: float) -> None:
    """With x right and z up the page, away from the vehicle; turned both ways too."""
    for degrees, colour in ((-TURN_DEG, RED), (TURN_DEG, RED), (0.0, INK)):
        turn = np.radians(degrees)
        flat = points[:, [0, 2]] @ np.array(
            [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
        )
        at = flat * (SCALE, -SCALE) + (x, y)
        width = 3 if degrees == 0 else 1.5
        plane = at[points[:, 2] == 0]
        ends = plane[[plane[:, 0].argmin(), plane[:, 0].argmax()]]
        drawing.path("M" + " L".join(f"{px:.1f} {py:.1f}" for px, py in ends), colour, width)
        for px, py in at[points[:, 2] != 0]:
            cx, cy = ends.mean(axis=0)
            drawing.path(f"M{cx:.1f} {cy:.1f} L{px:.1f} {py:.1f}", colour, width)
        for px, py in at:
            filled = SUPPLY if degrees == 0 else "#ffffff"
            drawing.path(circle(px, py, 7 if degrees == 0 else 5), colour, 1.5, fill=filled)
    drawing.path(f"M{x} {y + 150} V{y + 118} m-6 10 l6 -10 l6 10", FAINT, 2)
    drawing.text(x + 14, y + 146, "the vehicle looks this way", size=14, colour=FAINT)


def dimension(drawing: Drawing, left: float, right: float, y: float, words: str) -> None:
    """A horizontal measure with its ends."""
    drawing.path(
        f"M{left:g} {y:g} H{right:g} M{left:g} {y - 6:g} v12 M{right:g} {y - 6:g} v12", FAINT
    )
    drawing.text((left + right) / 2, y + 22, words, size=14, anchor="middle")


def circle(x: float, y: float, radius: float) -> str:
    """An SVG path."""
    half = f"a{radius} {radius} 0 1 0"
    return f"M{x - radius:.1f} {y:.1f} {half} {2 * radius} 0 {half} {-2 * radius} 0"


if __name__ == "__main__":
    main()
