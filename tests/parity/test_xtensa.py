"""dockcore on the emulated Xtensa core: the golden values, and the dock's budgets."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import budgets
import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "xtensa.py"

DIFFERENT, MISSING = 1, 3  # exit statuses of the tool

WORKING_VALUES = 80 * 60 * 3
LIKELY_BINS = 5  # whichever is thought the fullest, the background is the same
# Of every frame in golden.json, with what the dock counts beside it.
DOCK_VALUES = len(["decided_hue", "marker_hue", "decided", "frames", "camera", "frame faults"])


@pytest.fixture(scope="module")
def measured() -> dict[str, Any]:
    """All that the tool has to say; it builds once and runs for a second."""
    done = subprocess.run(
        [sys.executable, str(TOOL), "--json"], capture_output=True, text=True, timeout=300
    )
    if done.returncode == MISSING:
        pytest.skip(done.stderr.strip())
    assert done.returncode in (0, DIFFERENT), done.stderr
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def scalars(values: Iterable[Any]) -> int:
    return sum(len(value) if isinstance(value, list) else 1 for value in values)


def background_values(frame: dict[str, Any]) -> int:
    """Of one frame: its background's fields."""
    fields = {name: value for name, value in frame["background"].items() if name != "rgb"}
    return scalars(fields.values())


def test_every_golden_value_was_compared(measured: dict[str, Any], golden: dict[str, Any]) -> None:
    expected = {}
    for frame in golden["frames"]:
        background = background_values(frame)
        duties = len(frame["duties"])
        rgb = len(frame["background"]["rgb"])
        expected["stages", frame["name"]] = (
            1 + 2 * WORKING_VALUES + LIKELY_BINS * background + rgb + 1 + duties
        )  # whether it is valid, two images, ..., the marker's hue
        expected["dock", frame["name"]] = background + DOCK_VALUES + duties
    for number, sequence in enumerate(golden["rolling"]):
        expected["rolling", str(number)] = len(sequence["means"])
    for number, sequence in enumerate(golden["steady"]):
        expected["steady", str(number)] = len(sequence["shown"])
    for number, led in enumerate(golden["led"]):
        expected["led", str(number)] = len(led["duties"])
    for number, mapping in enumerate(golden["mappings"]):
        expected["mapping", str(number)] = len(mapping["hues"])
    compared = {(v["kind"], v["name"]): v["values"] for v in measured["vectors"]}
    assert compared == expected


def test_no_value_differs(measured: dict[str, Any]) -> None:
    assert measured["differences"] == []


@pytest.mark.parametrize(
    ("kind", "budget"),
    [("total", budgets.INSTRUCTIONS_QQVGA), ("cold", budgets.INSTRUCTIONS_COLD)],
)
def test_every_qqvga_frame_stays_within_the_budget_of_instructions(
    kind: str,
    budget: int,
    measured: dict[str, Any],
    golden: dict[str, Any],
    record_property: Callable[[str, object], None],
) -> None:
    names = {
        frame["name"]
        for frame in golden["frames"]
        if (frame["format"], frame["width"], frame["height"]) == ("rgb565", 160, 120)
    }
    counts = {name: stages[kind] for name, stages in measured["instructions"].items()}
    assert counts.keys() == names
    worst = max(counts, key=lambda name: counts[name])
    record_property("figure", f"Xtensa instructions a QQVGA frame, {kind}: {counts[worst]:,}")
    assert counts[worst] <= budget


def test_stages_add_up_to_the_total(measured: dict[str, Any]) -> None:
    for name, stages in measured["instructions"].items():
        parts = sum(count for stage, count in stages.items() if stage not in ("total", "cold"))
        assert parts <= stages["total"] <= parts + 1000, name  # checks, calls, counters


def test_memory_and_stack_stay_within_the_budget(measured: dict[str, Any]) -> None:
    assert 0 < measured["code_bytes"] <= budgets.CODE_BYTES
    assert 0 < measured["ram_bytes"] <= budgets.RAM_BYTES
    functions = {"dock_init", "dock_frame", "dock_led_duties", "dock_receive", "dock_transmit"}
    assert measured["stack"].keys() == functions
    assert 0 < max(measured["stack"].values()) <= budgets.STACK_BYTES
