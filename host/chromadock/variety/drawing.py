"""Draws a scene from a seed: a pure function."""

from __future__ import annotations

import numpy as np

from chromadock.variety.backdrops import Backdrops
from chromadock.variety.cameras import camera_model
from chromadock.variety.clutter import draw_things
from chromadock.variety.docks import ORIGINAL_WIDTH_M, Floats, dock_geometry
from chromadock.variety.factors import Draws, Fixed, Range, check_names, variety
from chromadock.variety.poses import pose_in_view
from chromadock.variety.scene import NO_DOCK, Scene

ATTENUATION = (0.05, 2.5)
"""1/m: the clearest and the murkiest water, whatever the dock's size."""
FARTHER = 1.15
"""A dock that does not fit into the frame at its distance is moved away by so much at a time."""


def draw(index: int, seed: int, backdrops: Backdrops, **fixed: Fixed) -> Scene:
    """The scene of a seed and an index.

    Parameters
    ----------
    fixed
        Factors not to be drawn, by the names in ``variety.toml``: ``camera="hd"``,
        ``distance="3"``, ``jpeg_quality=90``; also ``dock="none"``, and
        ``mounting``, which is ``upright`` unless it is given.

    Raises
    ------
    ChromadockError
        For a factor that there is not, or a choice that it does not have.
    """
    check_names(fixed)
    draws = Draws(seed, index, fixed)
    dock = draws.share("dock", (NO_DOCK,))
    width_m = _width(draws, dock)
    scale = width_m / ORIGINAL_WIDTH_M
    points = np.zeros((0, 3)) if dock == NO_DOCK else dock_geometry(dock, width_m).points
    camera, offset, distance_m, R, t, angles = _view(draws, points, scale)
    model = camera_model(camera, offset)
    clutter, things = draw_things(
        draws, model, R, t, model.project(points @ R.T + t), dock == NO_DOCK
    )
    mean = draws.between("attenuation") / scale
    c_red, c_green, c_blue = (
        float(np.clip(mean * spread, *ATTENUATION)) for spread in draws.several("channel", 3)
    )
    unlikeness = draws.between("unlikeness")
    unlike = draws.rng("lamp_gains").uniform(-unlikeness, unlikeness, len(points))
    photograph = backdrops.choose(draws.share("collection"), draws.rng("photograph"))
    if draws.share("backdrop") == "procedural":
        photograph = None
    daylight, entry = draws.share("daylight"), variety().cameras[camera]
    return Scene(
        seed=seed,
        index=index,
        dock=dock,
        width_m=width_m,
        build=draws.share("build"),
        colour=draws.share("colour"),
        mapping=draws.share("mapping"),
        lamp_profile=draws.share("lamp_profile"),
        lamp_radius_m=scale * draws.between("lamp_radius_m"),
        radiance=draws.between("radiance"),
        crosstalk=draws.between("crosstalk"),
        unlikeness=unlikeness,
        lamp_gains=tuple((1 + unlike).tolist()),
        holders_m=tuple(scale * d for d in draws.several("holder_m", len(points))),
        bar_width_m=scale * draws.between("bar_width_m"),
        bar_reflectance=draws.between("bar_reflectance"),
        camera=camera,
        principal_point="calibrated" if offset == (0.0, 0.0) else "off_centre",
        offset=offset,
        mounting=draws.share("mounting"),
        distance=draws.share("distance"),
        distance_m=distance_m,
        range_m=float(t[2]),
        pitch_deg=angles[0],
        yaw_deg=angles[1],
        roll_deg=angles[2],
        R=R,
        t=t,
        mean_attenuation=(c_red + c_green + c_blue) / 3,
        attenuation=(c_red, c_green, c_blue),
        halo_rad=draws.between("halo_rad"),
        scattered_share=draws.between("scattered_share"),
        backdrop="photograph" if photograph else "procedural",
        photograph=photograph,
        waters=draws.share("waters"),
        surface=draws.share("surface"),
        mirrored=draws.share("mirrored") == "yes",
        zoom=draws.between("zoom"),
        daylight=daylight,
        daylight_level=draws.of("daylight_level", variety().daylight[daylight]),
        exposure=draws.share("exposure"),
        exposure_gain=draws.of("exposure_gain", variety().locked[daylight]),
        target=draws.between("target"),
        white_balance=draws.share("white_balance"),
        balance=draws.between("balance"),
        shake_px=draws.between("shake_px"),
        shake_deg=draws.between("shake_deg"),
        field_shift_px=draws.between("field_shift_px") if entry.interlaced else 0.0,
        defocus_px=draws.between("defocus_px"),
        vignette=draws.between("vignette"),
        shot_noise=draws.between("shot_noise") * entry.noise,
        code_noise=draws.between("code_noise"),
        gamma=draws.between("gamma"),
        s_curve=draws.between("s_curve"),
        jpeg_quality=round(draws.between("jpeg_quality")),
        subsampling=draws.share("subsampling"),
        clutter=clutter,
        things=things,
    )


def _width(draws: Draws, dock: str) -> float:
    """Metres across; the original's where there is no dock."""
    own = None if dock == NO_DOCK else variety().docks[dock].width_m
    return (own or ORIGINAL_WIDTH_M) if dock == NO_DOCK or own else draws.between("width_m")


def _view(
    draws: Draws, points: Floats, scale: float
) -> tuple[str, tuple[float, float], float, Floats, Floats, list[float]]:
    """Camera, offset of its principal point, distance of a dock as wide as the original, R, t
    and pitch, yaw, roll.

    A camera that cannot see the dock whole at its distance leaves it to another.  If none can,
    the dock is farther away.
    """
    offset = (0.0, 0.0)
    if draws.share("principal_point") == "off_centre":
        right, down = draws.several("off_centre", 2)
        offset = (right, down)
    angles: dict[str, Range] = {
        name: draws.bounds(name) for name in ("pitch_deg", "yaw_deg", "roll_deg")
    }
    distance_m = float(draws.share("distance"))
    mounting = draws.share("mounting")
    while True:
        for camera in draws.ranked("camera"):
            model = camera_model(camera, offset)
            rng = draws.rng(f"pose {camera}")
            pose = pose_in_view(model, points, scale * distance_m, angles, mounting, rng)
            if pose is not None:
                R, t, turned = pose
                return camera, offset, distance_m, R, t, turned.tolist()
        distance_m *= FARTHER
