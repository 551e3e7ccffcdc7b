"""The camera and its calibration."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

from chromadock.camera import CameraModel
from chromadock.controls.opening import CameraSettings, controls_of
from chromadock.doctor.controls import ControlsCheck
from chromadock.doctor.finding import Finding
from chromadock.errors import ChromadockError
from chromadock.sources import Source, open_source

LOOK_S = 3.0
"""How long a camera is watched."""

LEAST_HZ = 5.0
"""A track needs so many frames a second of a vehicle that moves."""

LOST_SHARE = 0.7
"""Of the rate that a camera announces, what should come."""

OLD_S = 0.3
"""A picture that is older when it comes makes steering by it hard."""


def calibration(camera: CameraModel | None) -> Finding:
    """What the calibration says of the lens; it was checked when it was read."""
    if camera is None:
        return Finding(
            "warning",
            "calibration",
            "none is given: ranges are rough; calibrate in water and set camera.calibration",
        )
    rays = camera.rays([(0.0, camera.height / 2), (camera.width - 1.0, camera.height / 2)])
    cosine = float(rays[0] @ rays[1])
    across = f"{math.degrees(math.acos(max(-1.0, min(1.0, cosine)))):.0f} degrees across, "
    if not math.isfinite(cosine):
        across = ""
    return Finding(
        "ok", "calibration", f"{camera.width}x{camera.height}, {across}{camera.lens} lens"
    )


def camera(
    text: str, model: CameraModel | None, settings: CameraSettings | None = None
) -> Iterator[Finding]:
    """Whether the source ``text`` opens, how large its frames are, how many come, how old they are,
    and what of the camera is fixed, all of it when the camera is set as for a run."""
    settings = settings or CameraSettings()
    try:
        controls = ControlsCheck(controls_of(text, settings.manager), settings.wishes)
        with open_source(text) as source:
            if source.live:
                controls.set_before_pictures()
            yield from _watched(source, model)
            if source.live:
                yield from controls.findings()
    except ChromadockError as error:
        yield Finding("fault", "camera", str(error))


def _watched(source: Source, model: CameraModel | None) -> Iterator[Finding]:
    ages_s: list[float] = []
    came, shape, begun_s = 0, (0, 0), time.monotonic()
    for frame in source:
        if not came:
            begun_s = time.monotonic()  # the first one may have been waited for
        came, shape = frame.index + 1, frame.image.shape[:2]
        if (now_s := source.now()) is not None:
            ages_s.append(now_s - frame.time_s)
        if time.monotonic() - begun_s > LOOK_S:
            break
    if not came:
        yield Finding("fault", "camera", "gives no picture: check the cable or the network")
        return
    high, wide = shape
    yield _size(wide, high, model)
    if source.live:
        yield _rate((came - 1) / max(time.monotonic() - begun_s, 1e-3), source.fps)
        yield _age(sorted(ages_s)[len(ages_s) // 2])


def _size(wide: int, high: int, model: CameraModel | None) -> Finding:
    if model is not None and (model.width, model.height) != (wide, high):
        return Finding(
            "fault",
            "camera",
            f"frames are {wide}x{high} but calibrated for {model.width}x{model.height}: set the "
            "camera to that mode, or calibrate in this one",
        )
    return Finding("ok", "camera", f"opens, {wide}x{high}")


def _rate(rate_hz: float, announced_hz: float) -> Finding:
    words = f"{rate_hz:.1f} frames a second"
    if rate_hz < LEAST_HZ:
        return Finding(
            "fault", "rate", f"{words}: a track needs {LEAST_HZ:g}; shorten the exposure"
        )
    if rate_hz < LOST_SHARE * announced_hz:
        return Finding(
            "warning",
            "rate",
            f"{words} of {announced_hz:g} that are announced: a long exposure, a slow USB port or "
            "network takes the others",
        )
    return Finding("ok", "rate", words)


def _age(age_s: float) -> Finding:
    words = f"a picture is {1000 * age_s:.0f} ms old when it is read, by its own stamp"
    if age_s > OLD_S:
        return Finding(
            "warning", "delay", f"{words}: lower the encoder's buffer and its key frames"
        )
    return Finding("ok", "delay", words)
