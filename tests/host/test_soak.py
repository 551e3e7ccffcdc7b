from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import soak
from soak_truth import Truth, write_frames

from chromadock.colour.marker import RollingHue
from chromadock_firmware import Settings, ffi, lib

SECONDS = 8
REPORT_MS = 40


def test_eight_seconds_on_a_bad_line(tmp_path: Path, record_property: Any) -> None:
    run = soak.Soak(tmp_path, SECONDS, seed=1)
    run.run()
    for line in run.figures():
        record_property("figure", f"soak: {line}")
    assert run.faults == []
    assert run.watched >= SECONDS / 2
    for moved, damaged in zip(run.line.moved, run.line.damaged, strict=True):
        assert damaged == pytest.approx(soak.SHARE * moved, rel=0.5)
    assert run.truth.link_faults > 0


def reports(hues: list[int], period_ms: int, undecided: int | None = None) -> list[SimpleNamespace]:
    """What a dock tells that decides on ``hues``, but for the frame of number ``undecided``, by the
    host's own rolling mean."""
    rolling, statuses = RollingHue(), []
    for number in range(3 * len(hues)):
        hue, now = hues[number % len(hues)], number * period_ms
        if number + 1 != undecided:
            mean = rolling.add(hue, now)
        duty = ffi.new("uint16_t[3]")
        settings = Settings().to_c()
        lib.led_duties(duty, mean, ffi.addressof(settings, "led"))
        statuses.append(
            SimpleNamespace(
                time_boot_ms=now + 3,
                frames=number + 1,
                decided_hue=hue,
                marker_hue=mean,
                duty=list(duty),
                led_mode=0,
                link_faults=0,
            )
        )
    return statuses


@pytest.fixture(scope="module")
def hues(tmp_path_factory: pytest.TempPathFactory) -> list[int]:
    return write_frames(tmp_path_factory.mktemp("frames"))


@pytest.mark.parametrize("undecided", [None, 2])
@pytest.mark.parametrize("period_ms", [33, REPORT_MS, 100])
def test_the_truth_accepts_a_dock_that_is_right(
    hues: list[int], period_ms: int, undecided: int | None
) -> None:
    truth = Truth(hues)
    for status in reports(hues, period_ms, undecided):
        truth.take(status)
    assert truth.wrong == []
    assert truth.checked == 3 * len(hues)


def spoil(status: Any, what: str) -> None:
    if what == "decided_hue":
        status.decided_hue += 1
    elif what == "marker_hue":
        status.marker_hue = (status.marker_hue + 100) % 1536
    elif what == "duty":
        status.duty[0] ^= 1
    elif what == "led_mode":
        status.led_mode = 2
    elif what == "frames":
        status.frames += 1
    else:
        status.time_boot_ms = 0


@pytest.mark.parametrize("spoilt", [5, 150])
@pytest.mark.parametrize(
    "what", ["decided_hue", "marker_hue", "duty", "led_mode", "frames", "restart"]
)
def test_the_truth_tells_a_dock_that_is_wrong(hues: list[int], what: str, spoilt: int) -> None:
    truth = Truth(hues)
    for number, status in enumerate(reports(hues, REPORT_MS)):
        if number == spoilt:
            spoil(status, what)
        truth.take(status)
    assert len(truth.wrong) >= 1
    assert f"{spoilt * REPORT_MS + 3} ms" in truth.wrong[0] or what == "restart"


def test_a_mean_that_leaves_out_another_frame_is_wrong(hues: list[int]) -> None:
    truth = Truth(hues)
    for status in reports(hues, 100, undecided=8):
        truth.take(status)
    assert truth.wrong


def test_memory_that_grows_is_a_fault() -> None:
    run = object.__new__(soak.Soak)
    run.resident = {"dock": [100_000 + 100 * n for n in range(60)]}
    assert run.growth_kib("dock") > soak.MOST_GROWTH_KIB
