"""From the name that the user gave to the overlay's writer."""

from __future__ import annotations

import os
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.base import OverlayOutput
from chromadock.output.pictures import PICTURE_SUFFIXES, PictureFile, PictureFolder
from chromadock.output.video import VIDEO_CODECS, VideoOutput


def open_overlay(path: str | Path, count: int | None, fps: float) -> OverlayOutput:
    """The writer for ``path``: a video, one picture, or a folder of pictures.

    Parameters
    ----------
    path
        Ends in .mp4, .avi or .mkv: a video.  In .png or .jpg: a picture, for a source of one
        frame.  Anything else without a suffix, or a folder that is there: a picture a frame.
    count
        The source's number of frames, None where unknown.
    fps
        Frames a second of a video.

    Raises
    ------
    ChromadockError
        Where such a file cannot be, or its folder is missing.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    folder = path.resolve().parent
    if not folder.is_dir():
        raise ChromadockError(f"{path}: the folder {folder} does not exist: create it first")
    if not os.access(folder, os.W_OK):
        raise ChromadockError(f"{path}: cannot write into {folder}: choose another folder")
    if path.is_dir() or (not suffix and not path.exists()):
        return PictureFolder(path)
    if suffix in VIDEO_CODECS:
        return VideoOutput(path, fps)
    if suffix not in PICTURE_SUFFIXES:
        raise ChromadockError(
            f"{path}: cannot write such an overlay: "
            f"give a folder or a name ending in {', '.join((*VIDEO_CODECS, *PICTURE_SUFFIXES))}"
        )
    if count != 1:
        many = "many" if count is None else count
        raise ChromadockError(
            f"{path}: one picture cannot hold {many} frames: give a folder or a .mp4"
        )
    return PictureFile(path)
