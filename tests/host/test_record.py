"""A detection goes out as JSON and comes back as it was."""

from __future__ import annotations

import json
import math
import timeit
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from robust_composites import CAMERA, DOCK, compose

from chromadock import Detection, Detector
from chromadock.errors import ChromadockError
from chromadock.results.detection import Background, Blob, Marker, Misfit
from chromadock.results.pose import Pose
from chromadock.results.track import Track, TrackedPose

NUMBERS = st.floats(-1e4, 1e4)
SHARES = st.floats(0, 1)
RGBS = st.tuples(*[st.integers(0, 255)] * 3)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)
QUATERNIONS = st.tuples(*[st.floats(-1, 1)] * 4)
COVARIANCES = st.tuples(NUMBERS, st.just(math.nan), st.floats(1e-12, 1e-6)).map(lambda v: v * 12)
NAMES = st.text(min_size=1, max_size=12)
TRACKED = st.builds(TrackedPose, VECTORS, QUATERNIONS, COVARIANCES, SHARES)
SINGLE = st.builds(Pose, VECTORS, QUATERNIONS, NUMBERS, st.none(), st.none() | COVARIANCES)
POSES = SINGLE | st.builds(Pose, VECTORS, QUATERNIONS, NUMBERS, SINGLE, COVARIANCES)
DETECTIONS = st.builds(
    Detection,
    state=st.sampled_from(["found", "partial", "uncertain", "not_found"]),
    background=st.builds(Background, RGBS, st.none() | st.floats(0, 360), SHARES),
    marker=st.builds(
        Marker, st.none() | RGBS, st.none() | NUMBERS, st.none() | NUMBERS, st.none() | NAMES
    ),
    observed=st.none() | RGBS,
    passed_fraction=SHARES,
    blobs=st.lists(st.builds(Blob, NUMBERS, NUMBERS, NUMBERS, st.booleans()), max_size=3).map(
        tuple
    ),
    markers=st.none() | st.dictionaries(NAMES, st.tuples(NUMBERS, NUMBERS), max_size=5),
    pose=st.none() | POSES,
    evidence=st.none() | NUMBERS,
    track=st.none()
    | st.builds(
        Track,
        st.sampled_from(["tracking", "lost"]),
        NUMBERS,
        st.none() | TRACKED,
        st.none() | TRACKED,
        st.none() | VECTORS,
        st.none() | VECTORS,
        st.none() | SHARES,
    ),
    clipped=st.none() | SHARES,
    stops_over=st.none() | SHARES,
    misfit=st.none() | st.builds(Misfit, NUMBERS, NUMBERS),
    timing_ms=st.dictionaries(NAMES, NUMBERS, max_size=3),
)


def through_json(detection: Detection) -> Detection:
    line = json.dumps(detection.to_dict(), allow_nan=False)
    return Detection.from_dict({**json.loads(line), "file": "clip.mp4", "frame": 7})


@given(DETECTIONS)
@settings(max_examples=50)
def test_what_was_written_is_read(detection: Detection) -> None:
    """Rounded once, a detection comes back the same; every field of it, of the same type."""
    once = through_json(detection)
    assert repr(through_json(once)) == repr(once)  # NaN is not equal to itself
    assert once.to_dict() == detection.to_dict()
    for name, (x, y) in (detection.markers or {}).items():
        assert once.markers is not None
        assert once.markers[name] == pytest.approx((x, y), abs=0.006)


def test_a_real_detection_keeps_all_that_a_log_is_read_for() -> None:
    detector = Detector(CAMERA, DOCK)
    for k in range(5):
        scene = compose(
            np.full((480, 640, 3), (150, 120, 40), np.uint8), 2.5, np.random.default_rng(k)
        )
        detection = detector.process(scene.frame_bgr, 0.1 * k)
    back = through_json(detection)
    assert back.found and back.pose is not None and back.track is not None
    assert detection.pose is not None and detection.track is not None
    assert back.pose.t == pytest.approx(detection.pose.t, abs=1e-4)
    assert back.track.time_s == pytest.approx(0.4)
    assert back.blobs[0].accepted and isinstance(back.blobs, tuple)
    assert set(back.markers or {}) == set(DOCK.names)


def whole() -> dict[str, Any]:
    return Detection(
        "found", Background((1, 2, 3), None, 0.5), Marker(None, None), None, 0.1
    ).to_dict()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"schema": 2}, "of schema 2, but this chromadock reads 1"),
        ({"schema": None}, "of schema None"),
        ({"state": 3}, "state is 3"),
        ({"blobs": [[1, 2]]}, "a key has another form"),
        ({"track": {"state": "lost"}}, "without pose"),
        ({"background": {"rgb": [1, 2], "hue_deg": None, "confidence": 1}}, "background.rgb"),
    ],
)
def test_what_is_no_detection_is_refused_in_one_line(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ChromadockError, match=said) as refused:
        Detection.from_dict(whole() | change)
    assert "\n" not in str(refused.value)


def test_a_line_is_read_in_the_time_of_some_lines_of_json() -> None:
    """A ratio, for any computer: an hour has a hundred thousand lines."""
    line = json.dumps(whole())

    def least_s(read: Callable[[Any], object]) -> float:
        return min(timeit.repeat(lambda: read(json.loads(line)), number=10, repeat=5))

    assert least_s(Detection.from_dict) < 50 * least_s(lambda content: content)


def test_a_missing_key_is_named() -> None:
    for key in set(whole()) - {"found", "schema"}:
        with pytest.raises(ChromadockError, match=key):
            Detection.from_dict({k: v for k, v in whole().items() if k != key})
