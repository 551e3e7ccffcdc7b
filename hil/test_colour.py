"""Frames in, colours out."""

from __future__ import annotations

import golden
import pytest
from rig import FULL, Rig

from chromadock.parameter_table import PARAMETERS

MAPPINGS = next(p.values for p in PARAMETERS if p.name == "MAPPING")
LATENCY_MS = 60
"""10 ms in the dock, 16 ms in a USB adapter, and the status report's way."""


@pytest.mark.parametrize("name", golden.FITTING)
def test_a_golden_frame_gives_the_golden_colour_and_duties(rig: Rig, name: str) -> None:
    frame = golden.FRAMES[name]
    rig.dock.set_parameter("MAPPING", MAPPINGS.index(frame.mapping))
    status = golden.inject(rig, frame)
    assert status.decided_hue == frame.marker_hue
    assert status.marker_hue == frame.marker_hue
    assert list(status.duty) == frame.duties
    background = frame.background
    assert list(status.background_rgb) == background["rgb"]
    assert status.background_hue == (background["hue"] if background["meaningful"] else 0xFFFF)
    assert status.confidence == background["confidence"]


def test_an_injected_frame_reaches_the_duties_in_time(rig: Rig, record_property) -> None:
    frame = golden.FRAMES["saturated_qqvga"]
    late_ms = []
    for _ in range(3):  # the best: this computer may be busy with other things
        before = golden.hold(rig, frame)
        rig.send(*frame.messages[1])
        start = rig.wire.written()
        status = rig.wait("DOCK_STATUS", lambda s, n=before: s.frames == n + 1)
        late_ms.append(1000 * (rig.messenger.clock() - start))
        assert list(status.duty) == frame.duties
    record_property(
        "figure",
        f"last byte of a frame to the report of its duties, {rig.target.name}: "
        f"{min(late_ms):.1f} ms",
    )
    assert min(late_ms) < LATENCY_MS


def test_the_rolling_mean_follows_within_its_window(rig: Rig) -> None:
    first, second = golden.FRAMES["one_pixel_rgb565"], golden.FRAMES["saturation_26"]
    assert golden.inject(rig, first).marker_hue == first.marker_hue
    rig.dock.set_parameter("WINDOW_MS", 2000)
    announced, packets = second.messages
    rig.send(announced, *packets)
    both = rig.wait("DOCK_STATUS", lambda s: s.decided_hue == second.marker_hue)
    # Two decisions of the same weight, on the short way round.
    assert abs(both.marker_hue - (first.marker_hue + second.marker_hue) / 2) <= 1


def test_another_mapping_shows_its_hue_at_once(rig: Rig) -> None:
    frame = golden.FRAMES["pool_qqvga"]
    rig.dock.set_parameter("WINDOW_MS", 2000)
    assert golden.inject(rig, frame).marker_hue == frame.marker_hue
    rig.dock.set_parameter("MAPPING", MAPPINGS.index("complement"))
    sixth = 256  # from ternary's third of the wheel to its half
    assert rig.dock.status().marker_hue == (frame.marker_hue + sixth) % 1536


def test_grey_water_after_blue_shows_the_fallback_and_nothing_between(rig: Rig) -> None:
    water, grey = golden.FRAMES["pool_qqvga"], golden.FRAMES["noise_qqvga"]
    rig.dock.set_parameter("WINDOW_MS", 2000)
    for frame in (water, grey, water):
        rig.send(frame.messages[0], *frame.messages[1])
        seen = rig.wait("DOCK_STATUS", lambda s, f=frame: s.decided_hue == f.marker_hue)
        assert seen.marker_hue == frame.marker_hue


def test_a_frame_that_is_too_large_or_too_short_changes_nothing(rig: Rig) -> None:
    frame = golden.FRAMES["pool_qqvga"]
    shown = list(golden.inject(rig, frame).duty)
    before = rig.dock.status()
    whole = frame.messages[0]
    for size, width, height in ((10_000_000, 160, 120), (len(frame.data) - 2, 160, 120), (4, 0, 9)):
        whole.size, whole.width, whole.height = size, width, height
        whole.packets = min(-(-size // whole.payload), 65535)
        rig.send(whole)
        rig.text("injection refused")
        rig.texts.clear()
    after = rig.dock.status()
    assert (after.frames, list(after.duty)) == (before.frames, shown)
    assert after.link_faults >= before.link_faults + 3


def test_a_lost_packet_costs_its_frame_and_is_named(rig: Rig) -> None:
    lost = golden.FRAMES["pool_qqvga"]
    before = golden.hold(rig, lost)
    rig.send(*lost.messages[1][:5], *lost.messages[1][6:])
    assert "lost packet 5" in rig.text("injected frame dropped")
    assert rig.dock.status().frames == before
    good = golden.FRAMES["saturated_qqvga"]
    assert list(golden.inject(rig, good).duty) == good.duties


def test_the_camera_is_back_when_injection_ends(rig: Rig) -> None:
    frame = golden.FRAMES["one_pixel_rgb565"]
    held = golden.inject(rig, frame).frames
    rig.defaults()
    rig.status(lambda s: s.frames > held + 2 and s.decided_hue != frame.marker_hue)


def test_a_snapshot_is_what_the_camera_gave(rig: Rig) -> None:
    data, width, height = rig.dock.snapshot()
    assert (width, height, len(data)) == (160, 120, 38400)
    if not rig.target.is_board:
        assert data == golden.FRAMES["pool_qqvga"].data
    else:
        assert len(set(data)) > 4, "one colour: is the lens cap on?"


@pytest.mark.simulator
def test_the_first_colour_is_the_golden_one_of_the_camera_s_picture(rig: Rig) -> None:
    rig.reset()
    status = rig.status(lambda s: s.frames > 0)
    assert list(status.duty) == golden.FRAMES["pool_qqvga"].duties


@pytest.mark.board
def test_the_board_s_camera_delivers_living_frames(rig: Rig, record_property) -> None:
    rig.status(lambda s: s.frames > 20, 20)
    status = rig.dock.status()
    record_property("figure", f"camera of the board: {status.frame_rate_dhz / 10:.1f} frames/s")
    assert status.frame_rate_dhz > 40
    assert 0 < status.exposure <= 1200
    first, *_ = rig.dock.snapshot()
    second, *_ = rig.dock.snapshot()
    assert first != second, "no sensor is without noise"


def test_the_brightest_channel_is_on_for_the_whole_period(rig: Rig) -> None:
    status = rig.status(lambda s: s.frames > 0)
    assert max(status.duty) == FULL
    rig.dock.set_parameter("LED_ANODE", 1)
    assert min(rig.dock.status().duty) == 0
