"""The picture of one detection, laid out like the paper's figures.

Left the frame with the pose axes (the track's, where there is one), accepted blobs and marker
names; right what the colour mask let through, with accepted (green) and rejected (red) blobs;
below the colours and one line of text.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock import draw
from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.draw import BLUE, DIM, GREEN, INK, PAPER, RED, Canvas
from chromadock.results.detection import Blob, Detection
from chromadock.results.pose import Pose
from chromadock.results.track import Track, TrackedPose
from chromadock.rotation import matrix_from_quaternion

_GAP = 4
_MIN_PANEL = (320, 90)
"""Width and height below which the text would not fit."""
_SMALL, _LARGE = 320, 1280
"""Frames are enlarged up to, and reduced down to, these longer sides."""
_AXIS_SHARE = 0.25
"""Length of the pose axes as a share of the dock's largest extent."""


def draw_overlay(
    frame: NDArray[np.uint8],
    mask: NDArray[np.bool_] | NDArray[np.uint8],
    detection: Detection,
    camera: CameraModel,
    dock: DockGeometry,
) -> NDArray[np.uint8]:
    """Draw what was seen and what was made of it.

    Parameters
    ----------
    frame
        HxWx3 uint8, BGR; any size.
    mask
        HxW, nonzero where the colour mask let the pixel through.
    detection
        The result for this frame, in its pixels.
    camera, dock
        For the pose axes.

    Returns
    -------
    H'xW'x3 uint8, BGR, a new picture; its size depends on the frame's size only, both
    sides even, as video encoders want them.

    Raises
    ------
    ValueError
        Where ``frame`` and ``mask`` do not fit.
    """
    if frame.ndim != 3 or frame.shape[2] != 3 or mask.shape != frame.shape[:2]:
        raise ValueError(f"frame {frame.shape} and mask {mask.shape} do not fit")
    left = _seen(frame, detection, camera, dock)
    right = _panel(np.where(mask[:, :, None] != 0, frame, np.uint8(0)).astype(np.uint8))
    for blob in detection.blobs:
        _draw_blob(right, blob)
    above = np.concatenate([left.image, _filled(left.height, _GAP), right.image], axis=1)
    strip = _strip(above.shape[1], detection, left.text_px)
    return np.concatenate([above, strip], axis=0)


def draw_seen(
    frame: NDArray[np.uint8], detection: Detection, camera: CameraModel, dock: DockGeometry
) -> NDArray[np.uint8]:
    """Draw the left half of ``draw_overlay`` alone: what was found, on the frame.

    Parameters and the picture's kind are those of ``draw_overlay``.
    """
    return _seen(frame, detection, camera, dock).image


def _seen(
    frame: NDArray[np.uint8], detection: Detection, camera: CameraModel, dock: DockGeometry
) -> Canvas:
    """The frame with accepted blobs, the pose axes and the markers' names."""
    panel = _panel(frame)
    for blob in detection.blobs:
        if blob.accepted:
            _draw_blob(panel, blob)
    pose = _pose(detection)
    if pose is not None:
        _draw_axes(panel, pose, camera, dock)
    if detection.markers:
        _draw_names(panel, detection.markers)
    return panel


def _filled(height: int, width: int) -> NDArray[np.uint8]:
    return np.full((height, width, 3), PAPER, dtype=np.uint8)


def _panel(picture: NDArray[np.uint8]) -> Canvas:
    """The picture on a panel of readable, even size."""
    height, width = picture.shape[:2]
    longer = max(height, width)
    scale = 1.0
    if longer < _SMALL:
        scale = float(_SMALL // longer)
    elif longer > _LARGE:
        scale = _LARGE / longer
    scaled = draw.resized(picture, scale)
    high, wide = scaled.shape[:2]
    panel = _filled(max(high + high % 2, _MIN_PANEL[1]), max(wide + wide % 2, _MIN_PANEL[0]))
    top, left = (panel.shape[0] - high) // 2, (panel.shape[1] - wide) // 2
    panel[top : top + high, left : left + wide] = scaled
    return Canvas(panel, scale, left, top)


def _draw_blob(canvas: Canvas, blob: Blob) -> None:
    """A ring around the blob, not over it."""
    radius = max(blob.radius * canvas.scale, 2.0) + 1.5 + canvas.line_px
    canvas.circle((blob.x, blob.y), radius, GREEN if blob.accepted else RED)


def _pose(detection: Detection) -> Pose | TrackedPose | None:
    """The track's, else this frame's."""
    if detection.track is not None and detection.track.pose is not None:
        return detection.track.pose
    return detection.pose


def _draw_axes(
    canvas: Canvas, pose: Pose | TrackedPose, camera: CameraModel, dock: DockGeometry
) -> None:
    """The dock's axes from its origin: x red, y green, z blue."""
    length = _AXIS_SHARE * float(np.ptp(dock.points, axis=0).max())
    tips_dock = np.concatenate([np.zeros((1, 3)), np.eye(3) * length])
    rotation = matrix_from_quaternion(pose.q_wxyz)
    pixels = camera.project(tips_dock @ rotation.T + np.array(pose.t))
    # z last: it points away from the viewer and is short, so the others would hide it.
    for axis, colour in ((1, RED), (2, GREEN), (3, BLUE)):
        canvas.arrow(pixels[0], pixels[axis], colour)


def _draw_names(canvas: Canvas, markers: dict[str, tuple[float, float]]) -> None:
    """Each marker's name on its outer side, so that close markers' names keep apart."""
    centre = np.mean(list(markers.values()), axis=0)
    for name, (x, y) in markers.items():
        canvas.label(name, (x, y), to_right=x >= centre[0], below=y >= centre[1])


def _strip(width: int, detection: Detection, text_px: int) -> NDArray[np.uint8]:
    """Three swatches and a line of text."""
    pad = max(4, text_px // 2)
    height = 2 * (text_px + pad) + pad
    height += height % 2
    strip = _filled(height, width)
    swatch = int(text_px * 5.6)
    x = pad
    for label, rgb in _swatches(detection):
        draw.swatch(strip, (x, pad), (swatch, height - 2 * pad), label, rgb, text_px)
        x += swatch + pad
    colour = GREEN if detection.found else DIM
    state, rest = _words(detection)
    x += pad
    x += draw.text(strip, state, (x, height // 2), text_px, colour, room=width - x - pad)
    draw.text(strip, rest, (x, height // 2), text_px, INK, room=width - x - pad)
    return strip


def _swatches(detection: Detection) -> list[tuple[str, tuple[int, int, int] | None]]:
    """Label and RGB of the water's colour, its pure hue (None: no hue) and the marker's."""
    hue = detection.background.hue_deg
    return [
        ("water", detection.background.rgb),
        ("pure", None if hue is None else draw.pure_rgb(hue)),
        ("marker", detection.marker.rgb),
    ]


def _words(detection: Detection) -> tuple[str, str]:
    state = detection.state.replace("_", " ")
    track = "" if detection.track is None else f"   track {_track_words(detection.track)}"
    if detection.pose is None:
        rejected = sum(not blob.accepted for blob in detection.blobs)
        if not detection.blobs:
            return state, f"   no blobs{track}"
        return state, f"   {len(detection.blobs)} blobs, {rejected} rejected{track}"
    distance = float(np.linalg.norm(detection.pose.t))
    error = detection.pose.reprojection_px
    return state, f"   range {distance:.2f} m   error {error:.2f} px{track}"


def _track_words(track: Track) -> str:
    """The state, and where the dock is by all frames."""
    state = track.state.replace("_", " ")
    if track.pose is None:
        return state
    either = "" if track.alternative is None else f", {100 * track.pose.weight:.0f} % sure"
    return f"{state}, {float(np.linalg.norm(track.pose.t)):.2f} m{either}"
