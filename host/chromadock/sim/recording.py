"""Simulated frames on the disk: pictures or a video, the truth, and the camera's calibration.

Everything is written under temporary names and renamed at the end.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from functools import partial
from pathlib import Path
from shutil import rmtree
from typing import Any

import cv2
import numpy as np
import yaml
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.errors import ChromadockError
from chromadock.output import Output, VideoOutput, json_line
from chromadock.output.base import cannot_write, partial_name
from chromadock.output.video import VIDEO_CODECS
from chromadock.sim.camera_spec import CameraSpec
from chromadock.sim.renderer import Frame

TRUTH = "truth.jsonl"
CAMERA = "camera.yaml"
"""Names in a folder; beside a video they follow its name and a dot."""

Made = tuple[dict[str, Any], NDArray[np.uint8] | None]
"""A line of truth, and the picture where it is not written yet."""

# Noise hardly compresses, however long the encoder tries.
_PNG = [cv2.IMWRITE_PNG_COMPRESSION, 1]


class Recording(Output):
    """Takes frames in order: what ``finish`` made of each, in any process, goes to ``write``."""

    finish: Callable[[Frame], Made]
    _truth: Path
    """Where lines of it go until all is done."""

    @abstractmethod
    def write(self, made: Made) -> None:
        """Add a frame.

        Raises
        ------
        ChromadockError
            Where it cannot be written.
        """


class FolderRecording(Recording):
    """``000000.jpg`` and so on, the truth and the camera, in a new folder.

    Pictures have the camera's own JPEG quality, which changes next to nothing in what has gone
    through it once; those of a camera that does not compress are PNG.

    Raises
    ------
    ChromadockError
        Where the folder has files in it or cannot be written.
    """

    def __init__(self, path: Path, camera: CameraSpec) -> None:
        self._path = path
        self._partial = partial_name(path)
        try:
            if path.exists() and any(path.iterdir()):
                raise ChromadockError(
                    f"{path}: there are files in it: give a new or an empty folder"
                )
            self._partial.mkdir()
            write_camera(self._partial / CAMERA, camera.model)
        except OSError as error:
            self.drop()
            raise cannot_write(path, error) from None
        self._truth = self._partial / TRUTH
        quality = camera.sensor.jpeg_quality
        self.finish = partial(_write_picture, self._partial, path, quality)

    def write(self, made: Made) -> None:
        """Add a line of truth to the picture that is written already."""
        _write_truth(self._truth, made, self._path)

    def keep(self) -> None:
        """Give the folder its name."""
        try:
            self._partial.replace(self._path)
        except OSError as error:
            self.drop()
            raise cannot_write(self._path, error) from None

    def drop(self) -> None:
        """Remove the folder."""
        rmtree(self._partial, ignore_errors=True)


class VideoRecording(Recording):
    """A video, with the truth and the camera beside it.

    Raises
    ------
    ChromadockError
        Where one of them is there already or cannot be written.
    """

    def __init__(self, path: Path, camera: CameraSpec, fps: float) -> None:
        self._path = path
        self._beside = [path.with_name(f"{path.name}.{name}") for name in (TRUTH, CAMERA)]
        for place in (path, *self._beside):
            if place.exists():
                raise ChromadockError(f"{place}: it is there already: give a new name")
        self._truth, self._partial_camera = (partial_name(place) for place in self._beside)
        self._video = VideoOutput(path, fps)
        self.finish = _with_picture
        try:
            write_camera(self._partial_camera, camera.model)
        except OSError as error:
            self.drop()
            raise cannot_write(path, error) from None

    def write(self, made: Made) -> None:
        """Encode the picture, and add a line of truth."""
        _write_truth(self._truth, made, self._path)
        _, picture = made
        assert picture is not None
        self._video.write(picture, "", 0)

    def keep(self) -> None:
        """Give the files their names, the video last: where it is, all is."""
        try:
            for part, place in zip((self._truth, self._partial_camera), self._beside, strict=True):
                part.replace(place)
            self._video.keep()
        except (OSError, ChromadockError) as error:
            self.drop()
            for place in self._beside:
                place.unlink(missing_ok=True)
            if isinstance(error, OSError):
                raise cannot_write(self._path, error) from None
            raise

    def drop(self) -> None:
        """Remove them."""
        self._video.drop()
        self._truth.unlink(missing_ok=True)
        self._partial_camera.unlink(missing_ok=True)


def open_recording(path: Path, camera: CameraSpec, fps: float) -> Recording:
    """A video for a name such as x.mp4, otherwise a folder of pictures.

    Raises
    ------
    ChromadockError
        Where nothing can be written there.
    """
    folder = path.resolve().parent
    if not folder.is_dir():
        raise ChromadockError(f"{path}: the folder {folder} does not exist: create it first")
    suffix = path.suffix.lower()
    if suffix in VIDEO_CODECS:
        return VideoRecording(path, camera, fps)
    if suffix or path.is_file():
        kinds = ", ".join(VIDEO_CODECS)
        raise ChromadockError(f"{path}: give a folder, or a video's name ending in {kinds}")
    return FolderRecording(path, camera)


def _write_picture(folder: Path, wanted: Path, quality: int | None, frame: Frame) -> Made:
    suffix, how = (
        (".png", _PNG) if quality is None else (".jpg", [cv2.IMWRITE_JPEG_QUALITY, quality])
    )
    _, encoded = cv2.imencode(suffix, frame.image_bgr, how)
    try:
        (folder / f"{frame.truth.index:06d}{suffix}").write_bytes(encoded.tobytes())
    except OSError as error:
        raise cannot_write(wanted, error) from None
    return frame.truth.to_dict(), None


def _with_picture(frame: Frame) -> Made:
    return frame.truth.to_dict(), frame.image_bgr


def _write_truth(truth: Path, made: Made, wanted: Path) -> None:
    try:
        # Opened each time: a file kept open on a full disk cannot even be closed.
        with truth.open("a", encoding="utf-8") as lines:
            print(json_line(made[0]), file=lines)
    except OSError as error:
        raise cannot_write(wanted, error) from None


def write_camera(path: Path, camera: CameraModel) -> None:
    """The ``camera_info`` YAML that ``CameraModel.from_yaml`` reads."""
    content = {
        "image_width": camera.width,
        "image_height": camera.height,
        "camera_matrix": {"rows": 3, "cols": 3, "data": camera.matrix.ravel().tolist()},
        "distortion_model": camera.lens,
        "distortion_coefficients": {
            "rows": 1,
            "cols": camera.distortion.size,
            "data": camera.distortion.tolist(),
        },
    }
    path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
