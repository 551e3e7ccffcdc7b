"""How the camera of a source is reached, and what is to be set there."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from urllib.parse import urlsplit

from chromadock.controls.applying import Wishes
from chromadock.controls.base import Controls
from chromadock.controls.keeper import Keeper
from chromadock.controls.manager import PORT, CameraManager, ManagerAddress, manager_address

OpenControls = Callable[[], Controls]


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """What the camera of a source is to be set to.

    ``wishes``: see ``Wishes``; ``manager``: address of the camera manager that has the camera,
    empty where there is none, or the stream's computer is asked.
    """

    wishes: Wishes = field(default_factory=dict)
    manager: str = ""


def controls_of(source: str, manager: str = "") -> OpenControls | None:
    """What opens the controls of the camera that ``source`` names; None where there are none that
    could be reached: recordings, pictures, and pipelines, which set their cameras themselves.

    Raises
    ------
    ChromadockError
        Where ``manager`` is no address.
    """
    address = manager_address(manager) if manager else None
    if source.isascii() and source.isdigit():
        return _device(f"/dev/video{int(source)}")
    if _is_device(source):
        return _device(source)
    if address is not None:
        return partial(CameraManager, address, source)
    try:
        host = urlsplit(source).hostname if source.lower().startswith("rtsp") else None
    except ValueError:
        host = None
    return partial(CameraManager, ManagerAddress(host, PORT), source) if host else None


def keeper_of(
    source: str, name: str, settings: CameraSettings, tell: Callable[[str], None]
) -> Keeper | None:
    """What keeps the camera of ``source`` set; None where nothing is to be set, or nothing can be.

    ``name``: the source's in the lines that ``tell`` takes; see ``Keeper``.

    Raises
    ------
    ChromadockError
        Where the manager's address is none.
    """
    open_controls = controls_of(source, settings.manager)
    if not settings.wishes or open_controls is None:
        return None
    return Keeper(open_controls, settings.wishes, name, tell)


def cannot_be_set(name: str, wishes: Wishes, live: bool) -> str:
    """The line about keys that a source does not follow, for nothing can be set there; ``live``:
    whether it is a camera or a stream."""
    keys = ", ".join(f"camera.{key}" for key in wishes)
    mend = "no camera, so they change nothing"
    if live:
        mend = (
            "nothing can be set here: set the camera by its own means, or give camera.manager if a "
            "camera manager has it"
        )
    return f"{name}: {keys}: {mend}"


def _device(path: str) -> OpenControls | None:
    if sys.platform != "linux":
        return None
    from chromadock.controls.v4l2 import V4l2  # has modules that only Unix has

    return partial(V4l2, path)


def _is_device(text: str) -> bool:
    try:
        return stat.S_ISCHR(os.stat(text).st_mode)  # noqa: PTH116 - it need not be a path
    except (OSError, ValueError):
        return False
