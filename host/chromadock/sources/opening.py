"""From what the user typed to a ``Source``."""

from __future__ import annotations

import glob
import os
import re
import stat
from contextlib import suppress
from functools import partial
from pathlib import Path

from chromadock.choices import DEFAULT_FPS, LONGEST_DELAY_S
from chromadock.controls.keeper import Keeper
from chromadock.controls.opening import CameraSettings, cannot_be_set, keeper_of
from chromadock.errors import ChromadockError
from chromadock.sources.address import without_secrets
from chromadock.sources.bag_kind import is_bag, split_topic
from chromadock.sources.base import OnFault, Source, ignore
from chromadock.sources.device import open_device, open_gstreamer
from chromadock.sources.kept import kept
from chromadock.sources.kinds import check_readable
from chromadock.sources.live import Live
from chromadock.sources.order import natural_key
from chromadock.sources.pictures import IMAGE_SUFFIXES, Pictures, is_picture
from chromadock.sources.urls import open_url
from chromadock.sources.video_opening import open_video

_KINDS = "give a picture, a folder of pictures, a video, a recording, a camera index or a URL"
_URL = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+://")
_PIPELINE = "pipeline"
"""Pipelines are called so in messages, for they may hold passwords."""


def open_source(
    text: str,
    fps: float = DEFAULT_FPS,
    on_fault: OnFault = ignore,
    on_note: OnFault = ignore,
    delay_s: float = 0.0,
    camera: CameraSettings | None = None,
) -> Source:
    """Open what ``text`` names.

    Parameters
    ----------
    text
        A camera index (``0``) or device (``/dev/video0``), a video file, a picture, a
        folder or glob of pictures, an MCAP file or ROS bag (``dive.mcap``, with several topics of
        pictures ``dive.mcap?topic=/camera/image``), a GStreamer pipeline (has a ``!``), or a URL.
        What exists as a file wins over the other readings, except for bare camera indices.
    fps
        Frames a second of a folder or glob of pictures.
    on_fault
        Called with one line for each picture that is skipped, and for a video's missing end.
    on_note
        Called with one line for what had to be assumed of the pictures, and when a live source
        goes away or is back, then by its thread.
    delay_s
        From capture to arrival of a live source's pictures, seconds: see ``CaptureTime``.
    camera
        What a live source's camera is set to, each time that it is opened; what it does not follow
        goes to ``on_note``, then by another thread.

    Raises
    ------
    ChromadockError
        Where there is no such source, or it cannot be read.
    """
    if not (0 < fps < float("inf")):
        raise ChromadockError(f"--fps is {fps:g}: it must be a positive number")
    if not (0 <= delay_s <= LONGEST_DELAY_S):
        raise ChromadockError(
            f"--delay is {delay_s:g}: give the seconds from capture to arrival, "
            f"0 to {LONGEST_DELAY_S:g}"
        )
    camera = camera or CameraSettings()
    name = _live_name(text)
    keeper = keeper_of(text, name, camera, on_note)
    source = _opened(text, fps, on_fault, on_note, delay_s, keeper)
    if camera.wishes and (keeper is None or not source.live):
        shown = name if source.live else without_secrets(text)
        on_note(cannot_be_set(shown, camera.wishes, source.live))
    return source


def _opened(
    text: str,
    fps: float,
    on_fault: OnFault,
    on_note: OnFault,
    delay_s: float,
    keeper: Keeper | None,
) -> Source:
    """The source, by what kind it is of."""
    if _is_index(text):
        name = _live_name(text)
        return Live(kept(partial(open_device, int(text), name), keeper), name, on_note, delay_s)
    text, topic = split_topic(text)
    path = Path(text)
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:
        live = _live(text, on_fault, on_note, delay_s, keeper)
        return live or _not_a_path(text, fps, on_fault, on_note, error)
    if is_bag(path):
        from chromadock.sources.bag import open_bag  # takes long to load

        return open_bag(path, topic, on_fault)
    if topic is not None:
        raise ChromadockError(f"{path}: no recording, so it has no topic: leave ?topic= out")
    if stat.S_ISDIR(mode):
        return _folder(path, fps, on_fault, on_note)
    if stat.S_ISCHR(mode):
        return Live(kept(partial(open_device, text, text), keeper), text, on_note, delay_s)
    return _file(path, fps, on_fault, on_note)


def _is_index(text: str) -> bool:
    """Whether a camera is named by its number."""
    return text.isascii() and text.isdigit()


def _live_name(text: str) -> str:
    """What a camera, pipeline or stream is called in messages."""
    if _is_index(text):
        return f"camera {text}"
    return _PIPELINE if "!" in text and not _URL.match(text) else without_secrets(text)


def _live(
    text: str, on_fault: OnFault, on_note: OnFault, delay_s: float, keeper: Keeper | None
) -> Source | None:
    """What is no path and delivers frames by itself."""
    if _URL.match(text):
        return open_url(text, on_fault, on_note, delay_s, keeper)
    if "!" in text:
        return Live(kept(partial(open_gstreamer, text), keeper), _PIPELINE, on_note, delay_s)
    return None


def _not_a_path(
    text: str, fps: float, on_fault: OnFault, on_note: OnFault, error: Exception
) -> Source:
    """Globs; anything else was meant as a path."""
    if glob.has_magic(text):
        return _glob(text, fps, on_fault, on_note)
    shown = without_secrets(text)
    if isinstance(error, PermissionError):
        raise ChromadockError(f"{shown}: permission denied: allow reading it")
    raise ChromadockError(f"{shown}: no such file or folder: {_KINDS}")


def _file(path: Path, fps: float, on_fault: OnFault, on_note: OnFault) -> Source:
    try:
        with path.open("rb") as file:
            empty = not file.read(1)
    except OSError as error:
        raise ChromadockError(
            f"{path}: cannot be read ({error.strerror}): allow reading it"
        ) from None
    if empty:
        raise ChromadockError(f"{path}: the file is empty: copy it again")
    if is_picture(path):
        return Pictures([path], [path.name], fps, on_fault, on_note, single=True)
    return open_video(path, on_fault, on_note)


def _folder(path: Path, fps: float, on_fault: OnFault, on_note: OnFault) -> Source:
    try:
        files = sorted(path.iterdir(), key=lambda p: natural_key(p.name))
    except OSError as error:
        raise ChromadockError(
            f"{path}: cannot read the folder ({error.strerror}): allow reading it"
        ) from None
    inside = [p for p in files if _is_visible_image(p)]
    if not inside:
        _tell_kind(files)
        suffixes = " ".join(sorted(IMAGE_SUFFIXES))
        raise ChromadockError(f"{path}: no pictures in this folder: it needs some of {suffixes}")
    return Pictures(inside, [p.name for p in inside], fps, on_fault, on_note)


def _glob(pattern: str, fps: float, on_fault: OnFault, on_note: OnFault) -> Source:
    found = [Path(p) for p in glob.glob(pattern, recursive=True)]  # noqa: PTH207 - absolute, too
    files, found = found, [p for p in found if _is_visible_image(p)]
    if not found:
        _tell_kind(files)
        shown = without_secrets(pattern)
        raise ChromadockError(f"{shown}: no picture matches: check the pattern and the folder")
    found.sort(key=lambda p: natural_key(str(p)))
    above = os.path.commonpath([p.parent for p in found])
    return Pictures(
        found, [os.path.relpath(p, above or ".") for p in found], fps, on_fault, on_note
    )


def _tell_kind(files: list[Path]) -> None:
    """Say so where pictures of a kind that cannot be read were meant."""
    for file in files:
        with suppress(OSError):
            check_readable(file)


def _is_visible_image(path: Path) -> bool:
    """Dot files beside pictures are leftovers of other systems (``._001.jpg``)."""
    return (
        path.suffix.lower() in IMAGE_SUFFIXES and not path.name.startswith(".") and path.is_file()
    )
