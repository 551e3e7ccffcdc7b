"""Shipped scenes seen by a small camera, so that tests of the simulator are quick."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from chromadock.sim.scene import Scene, load_scene

SMALL = {"width = 640": "width = 160", "height = 480": "height = 120"} | {
    "focal_px = 512.0": "focal_px = 128.0",
    "centre_px = [319.5, 239.5]": "centre_px = [79.5, 59.5]",
}
STILL = {f"{body}.sway": {} for body in ("dock", "vehicle")}
"""Overrides: nothing bobs."""
PLAIN = STILL | {
    "body": [],
    "dock.frame": False,
    "light.flicker": False,
    "particles.concentration_per_m3": 0.0,
}
"""Overrides: nothing but water and lamps."""


def small_camera(folder: Path, **changes: str) -> str:
    """The shipped vehicle camera at a quarter of its size; ``key="value"`` lines replaced."""
    text = (resources.files("chromadock.sim") / "cameras" / "vehicle.toml").read_text("utf-8")
    for old, new in SMALL.items():
        assert old in text
        text = text.replace(old, new)
    for key, value in changes.items():
        lines = [f"{key} = {value}" if x.startswith(f"{key} =") else x for x in text.splitlines()]
        assert "\n".join(lines) != text, key
        text = "\n".join(lines)
    path = folder / "small.toml"
    path.write_text(text, "utf-8")
    return str(path)


def small_scene(
    name: str, folder: Path, overrides: Mapping[str, Any] | None = None, **camera: str
) -> Scene:
    """A shipped scene with that camera."""
    model = {"vehicle_camera.model": small_camera(folder, **camera)}
    return load_scene(name, {**model, **(overrides or {})})
