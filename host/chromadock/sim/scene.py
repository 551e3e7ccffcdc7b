"""A scene: everything that does not change while it is simulated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.dock import DockGeometry
from chromadock.mounting import R_BODY_CAMERA_FORWARD, Mounting
from chromadock.sim import scene_parts as parts
from chromadock.sim.ambient import Ambient
from chromadock.sim.basin import Basin
from chromadock.sim.body import Body
from chromadock.sim.camera_spec import CameraSpec
from chromadock.sim.lights import LampSpec
from chromadock.sim.motion import Motion
from chromadock.sim.particles import Suspension
from chromadock.sim.scene_bodies import body_of, frame_of
from chromadock.sim.scene_file import SHIPPED, SceneTables
from chromadock.sim.waves import GaussianField

__all__ = ["SHIPPED", "Overrides", "Scene", "load_scene"]

Overrides = Mapping[str, Any] | Sequence[Mapping[str, Any]] | None


@dataclass(frozen=True, eq=False)
class Scene:
    """What a simulation needs to know; pickles.

    Parameters
    ----------
    name
        The file's name without its ending.
    seed
        Of all that is random.
    ambient
        Water and daylight.
    waves
        Of the surface.
    basin
        Floor and wall.
    dock
        Where the markers are, and their colour where it does not follow the water.
    lamp
        What shines in each.
    dark_from_s
        (N,) when each marker's lamp fails; infinity: never.
    bodies
        All that is solid.
    motion
        Where everything is.
    suspension
        What drifts in the water; None: nothing.
    vehicle_camera, dock_camera
        The two cameras.
    """

    name: str
    seed: int
    ambient: Ambient
    waves: GaussianField
    basin: Basin
    dock: DockGeometry
    lamp: LampSpec
    dark_from_s: NDArray[np.float64]
    bodies: tuple[Body, ...]
    motion: Motion
    suspension: Suspension | None
    vehicle_camera: CameraSpec
    dock_camera: CameraSpec

    @property
    def mounting(self) -> Mounting | None:
        """What a user tells a detector of how the camera sits in this vehicle.

        None, nothing, where it sits as a detector takes it to sit: upright.
        """
        if not self.motion.camera_roll_deg:
            return None
        return Mounting(R_BODY_CAMERA_FORWARD @ self.motion.T_vehicle_camera.R)

    def works(self, time_s: float) -> NDArray[np.bool_]:
        """(N,) which markers' lamps work at a moment."""
        return time_s < self.dark_from_s


def load_scene(name_or_path: str | Path, overrides: Overrides = None) -> Scene:
    """The shipped scene of that name, or the one in a TOML file laid out like it.

    Parameters
    ----------
    name_or_path
        One of ``SHIPPED`` or a file; files that it names are looked for beside it.
    overrides
        Values that replace the file's, by dotted keys: ``{"vehicle.distance_m": 3.0}``; a number
        counts in a list from 0, as in ``"body.0.rgb"``, and ``+`` adds to one, as in ``"body.+"``.
        Missing tables are made.  Of several, one after the other is applied.

    Raises
    ------
    ChromadockError
        One line with the file, the key, what is wrong and what is allowed.
    """
    tables = SceneTables(str(name_or_path))
    for changes in [overrides] if isinstance(overrides, Mapping) else overrides or ():
        for key, value in changes.items():
            tables.put(key, value)
    file = tables.validated()
    waves, dock_sway, vehicle_sway, specks = (
        np.random.SeedSequence(file.seed).generate_state(4).tolist()
    )
    water = parts.named(f"{tables.source_of('water')}: water", lambda: parts.water_of(file.water))
    dock, dark_from_s = parts.dock_of(file.dock, tables.source_of("dock"))
    bodies = frame_of(dock, file.dock)
    for i, section in enumerate(file.body):
        where = f"{tables.source_of('body')}: body {i + 1}"
        bodies.append(parts.named(where, partial(body_of, section)))
    cameras = {
        key: parts.camera_of(getattr(file, key), f"{tables.source_of(key)}: {key}")
        for key in ("vehicle_camera", "dock_camera")
    }
    return Scene(
        name=Path(tables.source).stem,
        seed=file.seed,
        ambient=parts.ambient_of(file.light, water, waves),
        waves=GaussianField(waves, file.place.wind_m_s),
        basin=parts.basin_of(file.place),
        dock=dock,
        lamp=parts.lamp_of(file.dock.lamp),
        dark_from_s=dark_from_s,
        bodies=tuple(bodies),
        motion=parts.motion_of(file, tables.source, dock_sway, vehicle_sway),
        suspension=parts.suspension_of(file.particles, specks),
        **cameras,
    )
