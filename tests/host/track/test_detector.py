"""The track in ``Detector``, on composited frames and on photographs without a dock."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lit import to_linear
from robust_composites import CAMERA, DOCK, Water, add_lamp, photographed, read
from track_truth import NOTHING, rotation

from chromadock import Attitude, ChromadockError, Detection, Detector, Mounting
from chromadock.look import Found, Look
from chromadock.mounting import R_BODY_CAMERA_FORWARD
from chromadock.stopwatch import Stopwatch
from chromadock.track.candidate import PATIENT_SPAN_S

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "transdec"
HZ = 10


def water(rng: np.random.Generator) -> np.ndarray:
    light = np.linspace(1.2, 0.8, 480)[:, None, None] * np.array([40.0, 140.0, 190.0])
    return np.clip(light + rng.normal(0, 2, (480, 640, 3)), 0, 255).astype(np.uint8)


def pose(time_s: float) -> tuple[np.ndarray, np.ndarray]:
    return rotation(2, 10, 1), np.array([0.2 - 0.03 * time_s, 0.1, 3.0 - 0.3 * time_s])


def frame(time_s: float, out: tuple[int, ...] = ()) -> np.ndarray:
    """A dock under way; markers ``out`` are dark."""
    rng = np.random.default_rng(round(1000 * time_s))
    rgb = water(rng)
    seen = Water.of(rgb, np.random.default_rng(0))
    light = to_linear(rgb)
    R, t = pose(time_s)
    for i, point in enumerate(DOCK.points):
        if i not in out:
            place = R @ point + t
            shone = Water(np.full(3, 0.4), seen.veil, seen.lamp)
            add_lamp(light, shone, CAMERA.project(place)[0], float(np.linalg.norm(place)))
    return photographed(light, rng)


def run(detector: Detector, times: list[float], **changes: Any) -> list[Detection]:
    return [detector.process(frame(t, **changes), t) for t in times]


def times(start_s: float, seconds: float) -> list[float]:
    return [start_s + k / HZ for k in range(round(seconds * HZ))]


def test_a_dock_is_tracked_through_darkness_and_with_a_marker_out() -> None:
    detector = Detector(CAMERA, DOCK)
    seen = run(detector, times(0.0, 1.0))
    assert all(d.found for d in seen)
    assert [d.track.state for d in seen if d.track][:3] == ["acquiring", "acquiring", "tracking"]
    dark = [
        detector.process(water(np.random.default_rng(k))[..., ::-1].copy(), t)
        for k, t in enumerate(times(1.0, 0.5))
    ]
    assert not any(d.found for d in dark)
    assert dark[-1].track is not None and dark[-1].track.state == "recently_lost"
    back = run(detector, times(1.5, 2.0), out=(0,))
    states = [d.track.state for d in back if d.track]
    assert set(states[2:]) == {"tracking"}
    assert sum(d.state == "partial" for d in back) >= 10
    assert not any(d.found for d in back)
    last = back[-1].track
    assert last is not None and last.pose is not None
    poses = [p for p in (last.pose, last.alternative) if p]
    assert any(np.allclose(p.t, pose(3.4)[1], atol=0.05) for p in poses)


def test_the_track_goes_on_while_the_dock_looks_at_the_dark() -> None:
    """Its lamps are out for less than 0.2 s: two frames at most."""
    detector = Detector(CAMERA, DOCK)
    run(detector, times(0.0, 1.0))
    for k, t in enumerate((1.0, 1.1)):
        dark = detector.process(water(np.random.default_rng(k))[..., ::-1].copy(), t)
        assert dark.track is not None and dark.track.pose is not None
        assert np.allclose(dark.track.pose.t, pose(t)[1], atol=0.1)
    back = run(detector, times(1.2, 0.3))
    assert all(d.found and d.track and d.track.state == "tracking" for d in back)


def test_a_dock_with_a_marker_out_from_the_start_is_locked_in_clear_water(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A detector that treats frames alone finds none."""
    near = rotation(2, 10, 1), np.array([0.2, 0.1, 3.0])
    monkeypatch.setattr(sys.modules[__name__], "pose", lambda time_s: near)
    detector, alone = Detector(CAMERA, DOCK), Detector(CAMERA, DOCK, independent=True)
    seen = run(detector, times(0.0, PATIENT_SPAN_S + 1), out=(0,))
    assert not any(d.found for d in seen)
    last = seen[-1].track
    assert last is not None and last.state == "tracking" and last.pose is not None
    assert np.linalg.norm(last.pose.t) == pytest.approx(np.linalg.norm(near[1]), rel=0.05)
    assert alone.process(frame(0.0, out=(0,)), 0.0).state == "not_found"


def test_frames_alone_and_the_papers_method_have_no_track() -> None:
    for detector in (Detector(CAMERA, DOCK, independent=True), Detector(CAMERA, DOCK, "paper")):
        detection = detector.process(frame(0.0), 0.0)
        assert detection.track is None
        assert detection.to_dict()["track"] is None
        assert detector.predicted(1.0) is None


def test_the_track_reads_as_json() -> None:
    detector = Detector(CAMERA, DOCK)
    seen = run(detector, times(0.0, 0.5))
    first, last = (
        json.loads(json.dumps(d.to_dict(), allow_nan=False))["track"] for d in (seen[0], seen[-1])
    )
    assert first == {
        "state": "acquiring", "pose": None, "alternative": None, "velocity_m_s": None,
        "turn_rate_rad_s": None, "age_s": None, "time_s": 0.0,
    }  # fmt: skip
    assert last["state"] == "tracking" and last["age_s"] == 0
    assert len(last["pose"]["covariance"]) == 36 and len(last["velocity_m_s"]) == 3
    assert last["pose"]["t"] == pytest.approx(pose(0.4)[1].tolist(), abs=0.05)
    assert 0 < last["pose"]["weight"] <= 1


def test_latency_is_taken_out_by_asking_for_a_later_time() -> None:
    detector = Detector(CAMERA, DOCK)
    run(detector, times(0.0, 2.0))
    now = detector.predicted(2.1)
    assert now is not None and now.pose is not None
    assert now.age_s == pytest.approx(0.2)
    assert now.pose.t == pytest.approx(pose(2.1)[1], abs=0.06)


def test_an_attitude_is_taken_and_a_mounting() -> None:
    detector = Detector(CAMERA, DOCK, mounting=Mounting(np.eye(3)[[2, 0, 1]]))
    for t in times(0.0, 0.5):
        last = detector.process(frame(t), t, Attitude(0.0, 0.0))
    assert last.track is not None and last.track.state == "tracking"


class Listening:
    """A method that keeps what it is told."""

    mask = np.zeros((480, 640), np.uint8)

    def __init__(self) -> None:
        self.looks: list[Look] = []

    def find(self, look: Look, watch: Stopwatch) -> Found:
        self.looks.append(look)
        return NOTHING


@pytest.mark.parametrize("independent", [False, True])
def test_the_search_is_told_how_the_camera_sees_the_dock_turned(independent: bool) -> None:
    """A camera rolled by 90 degrees sees an upright dock rolled by -90; a vehicle upside down
    by 180; who tells nothing gets the upright search."""
    rolled = Mounting(R_BODY_CAMERA_FORWARD @ rotation(0, 0, 90))
    cases = (
        (rolled, None, -90.0),
        (None, Attitude(np.pi, 0.0), 180.0),
        (rolled, Attitude(np.radians(-30), 0.0, 1.0), -60.0),
        (None, None, None),
    )
    for mounting, attitude, roll_deg in cases:
        detector = Detector(CAMERA, DOCK, independent=independent, mounting=mounting)
        detector._method = method = Listening()  # type: ignore[assignment]
        detector.process(water(np.random.default_rng(0)), 0.0, attitude)
        R, covariance = method.looks[0].R_expected, method.looks[0].R_covariance
        if roll_deg is None:
            assert R is None and covariance is None
        else:
            assert R is not None and covariance is not None
            np.testing.assert_allclose(R, rotation(0, 0, roll_deg), atol=1e-12)
            assert np.linalg.eigvalsh(covariance).min() > 0


@pytest.mark.parametrize("mounting", [np.eye(3), "forward", 0])
def test_what_is_no_mounting_is_refused(mounting: Any) -> None:
    for independent in (False, True):
        with pytest.raises(ChromadockError, match="give Mounting"):
            Detector(CAMERA, DOCK, independent=independent, mounting=mounting)


def test_what_is_no_attitude_is_refused() -> None:
    with pytest.raises(ChromadockError, match="give Attitude"):
        Detector(CAMERA, DOCK).process(frame(0.0), 0.0, (0.0, 0.0, 0.0))  # type: ignore[arg-type]


@pytest.mark.parametrize("time_s", [np.nan, np.inf])
def test_a_time_that_is_no_number_is_refused(time_s: float) -> None:
    with pytest.raises(ChromadockError, match="time_s"):
        Detector(CAMERA, DOCK).process(frame(0.0), time_s)


@pytest.mark.skipif(not DATA.is_dir(), reason="no photographs: ../shared/data is missing")
@pytest.mark.parametrize("shaken", [False, True])
def test_no_photograph_held_for_three_seconds_locks(shaken: bool, record_property: Any) -> None:
    """As it is; or with new noise in each frame and the camera shaking by up to three pixels,
    so that frames differ as a real camera's do."""
    files = sorted(DATA.glob("*/*.jpg"))
    assert len(files) == 43
    detector, count, found, locked = Detector(CAMERA, DOCK), 0, 0, []
    most = 0.0
    noise = np.random.default_rng(99).normal(0, 2, (480, 640, 3)).round().astype(np.int16)
    for number, file in enumerate(files):
        picture, rng = read(file), np.random.default_rng(number)
        for k in range(30):
            seen = picture
            if shaken:
                shake, other = rng.integers(-3, 4, 2), rng.integers(0, 480, 2)
                seen = np.roll(picture, shake, (0, 1)) + np.roll(noise, other, (0, 1))
                seen = np.clip(seen, 0, 255).astype(np.uint8)
            # Ten seconds between photographs: nothing is left of the last.
            detection = detector.process(seen, 13.0 * number + k / 10)
            assert detection.track is not None
            count, found = count + 1, found + detection.found
            most = max(most, detection.evidence or 0.0)
            if detection.track.pose is not None:
                locked.append(file.stem)
    record_property(
        "figure",
        f"track: {len(locked)} frames locked of {count} on 43 photographs held for 3 s"
        f"{', shaken' if shaken else ''}; {found} frames found a dock, "
        f"with {most:.2f} decades at most",
    )
    assert not locked
