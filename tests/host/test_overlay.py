"""The overlay picture: its layout, and that what it shows is where it should be."""

import math
from dataclasses import replace

import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.draw import GREEN, RED, pure_rgb
from chromadock.overlay import draw_overlay
from chromadock.results.detection import Background, Blob, Detection, Marker
from chromadock.results.pose import Pose
from chromadock.results.track import Track, TrackedPose
from chromadock.rotation import matrix_from_quaternion

WATER = (31, 160, 201)
MARKER = (255, 0, 191)
DOCK = DockGeometry.default()


def detection(blobs=(), markers=None, pose=None, hue=194.5):
    return Detection(
        "found" if pose else "not_found",
        Background(WATER, hue, 0.9),
        Marker(MARKER, 314.5),
        (143, 160, 201),
        0.01,
        tuple(blobs),
        markers,
        pose,
    )


def drawn(width=640, height=480, mask=None, camera=None, fill=WATER[::-1], **what):
    frame = np.full((height, width, 3), fill, np.uint8)
    mask = np.zeros((height, width), bool) if mask is None else mask
    camera = camera or CameraModel.nominal(width, height)
    return draw_overlay(frame, mask, detection(**what), camera, DOCK)


def near(picture, colour, tolerance=60):
    """Pixels (y, x) that look like ``colour``, BGR."""
    apart = np.abs(picture.astype(int) - np.array(colour)).max(axis=2)
    return np.argwhere(apart < tolerance)


def test_left_is_the_frame_and_right_what_the_mask_let_through():
    mask = np.zeros((480, 640), bool)
    mask[100:200, 300:400] = True
    picture = drawn(mask=mask)
    assert picture.dtype == np.uint8
    assert (picture[:480, :640] == WATER[::-1]).all()
    right = picture[:480, -640:]
    assert (right[100:200, 300:400] == WATER[::-1]).all()
    assert right.sum() == right[100:200, 300:400].sum()


def test_a_mask_of_bytes_works_like_one_of_booleans():
    mask = np.zeros((480, 640), bool)
    mask[10:20, 10:20] = True
    assert (drawn(mask=mask) == drawn(mask=mask.astype(np.uint8) * 255)).all()


def test_the_arguments_are_left_as_they_were():
    frame = np.full((480, 640, 3), 90, np.uint8)
    mask = np.ones((480, 640), bool)
    blobs = [Blob(320, 240, 9, True)]
    camera = CameraModel.nominal(640, 480)
    draw_overlay(frame, mask, detection(blobs), camera, DOCK)
    assert (frame == 90).all()
    assert mask.all()


def test_accepted_blobs_are_green_on_both_sides_and_rejected_ones_red_on_the_right():
    picture = drawn(blobs=[Blob(100, 50, 6, True), Blob(500, 400, 6, False)])
    left, right = picture[:480, :640], picture[:480, -640:]
    for panel in (left, right):
        where = near(panel, GREEN)
        assert len(where) > 20
        assert np.abs(where.mean(axis=0) - (50, 100)).max() < 1
    where = near(right, RED)
    assert len(where) > 20
    assert np.abs(where.mean(axis=0) - (400, 500)).max() < 1
    assert len(near(left, RED)) == 0


def test_the_axes_start_at_the_dock_and_point_along_it():
    turn = math.radians(20)
    q = (math.cos(turn / 2), 0.0, 0.0, math.sin(turn / 2))
    pose = Pose((0.2, -0.1, 1.5), q, 0.4)
    camera = CameraModel.nominal(640, 480)
    picture = drawn(pose=pose, camera=camera)[:480, :640]
    rotation = matrix_from_quaternion(q)
    tip = camera.project([rotation @ (0.15, 0, 0) + pose.t])[0]
    x, y = np.round(tip).astype(int)
    blue, green, red = picture[y, x]
    assert red > 200 > green
    tip = camera.project([rotation @ (0, 0.15, 0) + pose.t])[0]
    x, y = np.round(tip).astype(int)
    blue, green, red = picture[y, x]
    assert green > 200 > red
    assert blue < 150


def tracked(pose, weight=1.0, alternative=None):
    """A detection of nothing in this frame, with a track all the same."""
    where = TrackedPose(pose.t, pose.q_wxyz, (0.0,) * 36, weight)
    track = Track("recently_lost", 1.0, where, alternative, age_s=0.5)
    return replace(detection(), track=track)


def test_the_axes_are_the_tracks_where_there_is_one():
    camera, frame = CameraModel.nominal(640, 480), np.full((480, 640, 3), 90, np.uint8)
    pose = Pose((0.2, -0.1, 1.5), (1, 0, 0, 0), 0.4)
    picture = draw_overlay(frame, frame[..., 0] > 0, tracked(pose), camera, DOCK)
    x, y = np.round(camera.project([np.add((0.15, 0, 0), pose.t)])[0]).astype(int)
    _, green, red = picture[y, x]
    assert red > 200 > green


def test_the_text_tells_the_tracks_state_and_how_sure_it_is():
    frame, pose = np.full((480, 640, 3), 90, np.uint8), Pose((0, 0, 2.0), (1, 0, 0, 0), 0.4)
    other = TrackedPose(pose.t, pose.q_wxyz, (0.0,) * 36, 0.3)
    strips = [
        draw_overlay(frame, frame[..., 0], each, CameraModel.nominal(640, 480), DOCK)[480:]
        for each in (detection(), tracked(pose), tracked(pose, 0.7, other))
    ]
    assert (strips[0] != strips[1]).any() and (strips[1] != strips[2]).any()


def test_a_pose_behind_the_camera_draws_no_axes():
    plain = drawn()[:480]
    assert (drawn(pose=Pose((0, 0, -1.0), (1, 0, 0, 0), 0.4))[:480] == plain).all()
    assert (drawn(pose=Pose((0, 0, 1e-9), (1, 0, 0, 0), 0.4))[:480] == plain).mean() > 0.9


def test_marker_names_stand_beside_their_markers():
    # On the left half only two corners, so the names cannot be mixed up with others.
    markers = {"a": (200.0, 200.0), "b": (400.0, 300.0)}
    changed = (drawn(markers=markers) != drawn()).any(axis=2)[:480, :640]
    ys, xs = np.nonzero(changed)
    left = xs < 300
    assert left.any()
    assert (~left).any()
    assert xs[left].max() < 200
    assert ys[left].max() < 200
    assert xs[~left].min() > 400
    assert ys[~left].min() > 300
    assert np.hypot(xs[left] - 200, ys[left] - 200).max() < 40


def test_swatches_show_water_pure_hue_and_marker_in_this_order():
    picture = drawn(fill=(0, 0, 0))
    strip = picture[480:]
    pure = pure_rgb(194.5)
    order = [near(strip, rgb[::-1], 3)[:, 1].mean() for rgb in (WATER, pure, MARKER)]
    assert order == sorted(order)
    assert order[2] < 320


def test_water_without_a_hue_shows_none():
    with_hue, without = drawn(), drawn(hue=None)
    assert len(near(with_hue[480:], pure_rgb(194.5)[::-1], 3)) > 500
    assert len(near(without[480:], pure_rgb(194.5)[::-1], 3)) == 0


def test_the_text_tells_found_from_not_found():
    pose = Pose((0, 0, 2.0), (1, 0, 0, 0), 0.4)
    strip = {name: drawn(pose=p)[480:, 260:] for name, p in (("found", pose), ("not", None))}
    assert len(near(strip["found"], GREEN, 30)) > 20
    assert len(near(strip["not"], GREEN, 30)) == 0


@pytest.mark.parametrize(
    ("width", "height"), [(1, 1), (3, 1), (1, 300), (160, 120), (321, 241), (1921, 1081)]
)
def test_frames_of_any_size_give_a_picture_that_encoders_take(width, height):
    mask = np.ones((height, width), bool)
    pose = Pose((0, 0, 1.0), (1, 0, 0, 0), 0.4)
    blobs = [Blob(0, 0, 1, True), Blob(1e9, math.nan, 1, False), Blob(5, 5, math.inf, False)]
    markers = {"top_left": (0.0, 0.0), "far": (-1e7, 1e7)}
    picture = drawn(width, height, mask, blobs=blobs, pose=pose, markers=markers)
    assert picture.dtype == np.uint8
    high, wide, channels = picture.shape
    assert channels == 3
    assert high % 2 == 0
    assert wide % 2 == 0
    assert 640 <= wide <= 2600
    assert high <= 1400
    # Nothing of the result moves the picture's size, or a video would break.
    assert drawn(width, height).shape == picture.shape


def test_a_frame_of_one_pixel_is_enlarged_to_be_seen():
    picture = drawn(1, 1, np.ones((1, 1), bool))
    assert (picture[:320, :320] == WATER[::-1]).mean() > 0.95


def test_a_mask_that_does_not_fit_is_our_own_bug():
    with pytest.raises(ValueError, match="do not fit"):
        drawn(mask=np.zeros((4, 4), bool))
