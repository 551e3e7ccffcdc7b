"""Parameters over MAVLink's parameter protocol."""

from __future__ import annotations

import itertools
import math
import statistics

import pytest
from rig import Rig, parameter_read, parameter_set

from chromadock import dialect
from chromadock.link.values import TABLE, step
from chromadock.parameter_table import PARAMETERS, Parameter

NAMES = [p.name for p in PARAMETERS]
SAVE, RESET = 1, 2
STORE = dialect.MAV_CMD_PREFLIGHT_STORAGE


def shown(value: float) -> str:
    """As the dock writes it: at most three decimals, and never more than is allowed."""
    return f"{math.trunc(value * 1000) / 1000:.3f}".rstrip("0").rstrip(".")


def set_raw(rig: Rig, name: str, value: float) -> float:
    """What the dock answers to PARAM_SET, refused or not."""
    rig.send(parameter_set(name, value))
    return float(rig.wait("PARAM_VALUE", lambda m: m.param_id == name).param_value)


def test_the_list_has_every_parameter_once_in_order(rig: Rig) -> None:
    rig.send(dialect.MAVLink_param_request_list_message(50, 1))
    heard = rig.heard_until(
        lambda m: m.get_type() == "PARAM_VALUE" and m.param_index == len(NAMES) - 1
    )
    values = [m for m in heard if m.get_type() == "PARAM_VALUE"]
    assert [m.param_id for m in values] == NAMES
    assert [m.param_index for m in values] == list(range(len(NAMES)))
    assert {m.param_count for m in values} == {len(NAMES)}
    assert {m.param_type for m in values} == {dialect.MAV_PARAM_TYPE_REAL32}


@pytest.mark.parametrize("name", NAMES)
def test_a_parameter_takes_its_whole_range_and_nothing_beyond(rig: Rig, name: str) -> None:
    row: Parameter = TABLE[name]
    for value in (row.minimum, row.maximum, row.default):
        assert rig.dock.set_parameter(name, value) == pytest.approx(value, abs=1e-4)
        assert rig.dock.parameter(name) == pytest.approx(value, abs=1e-4)
    allowed = f"{name} refused: allowed {shown(row.minimum)} to {shown(row.maximum)}"
    faults = rig.dock.status().link_faults
    for value in (row.minimum - step(row), row.maximum + step(row), float("nan"), float("inf")):
        rig.texts.clear()
        assert set_raw(rig, name, value) == pytest.approx(row.default, abs=1e-4)
        assert rig.text(name) == allowed
    assert rig.dock.status().link_faults == faults + 4


def test_an_unknown_parameter_is_refused_by_name(rig: Rig) -> None:
    rig.send(parameter_set("LED_COLOR", 1))
    assert rig.text("LED_COLOR") == "LED_COLOR: no such parameter"
    rig.texts.clear()
    rig.send(parameter_read("NO_SUCH_PARAM_16"))
    rig.text("NO_SUCH_PARAM_16: no such parameter")
    assert list(rig.dock.parameters()) == NAMES


def test_saved_parameters_outlast_a_restart_and_others_do_not(rig: Rig) -> None:
    rig.dock.set_parameter("REPORT_HZ", 7)
    rig.dock.set_parameter("LED_M_RG", -0.25)
    rig.dock.save()
    rig.dock.set_parameter("WINDOW_MS", 1234)
    rig.reset()
    rig.alive()
    values = rig.dock.parameters()
    assert (values["REPORT_HZ"], values["LED_M_RG"]) == (7, -0.25)
    assert values["WINDOW_MS"] == TABLE["WINDOW_MS"].default


def test_a_reset_brings_every_default_and_keeps_flash_until_saved(rig: Rig) -> None:
    rig.dock.set_parameter("REPORT_HZ", 3)
    rig.dock.save()
    rig.dock.set_parameter("LED_LIMIT", 99)
    rig.dock.set_parameter("LED_ANODE", 1)
    rig.dock.reset()
    defaults = {p.name: pytest.approx(p.default, abs=1e-4) for p in PARAMETERS}
    defaults |= {"LED_LIMIT": 99, "LED_ANODE": 1}  # the wiring's: a reset leaves them
    defaults["LINK_BAUD"] = rig.dock.parameter("LINK_BAUD")  # the line's
    assert rig.dock.parameters() == defaults
    rig.reset()
    rig.alive()
    assert rig.dock.parameter("REPORT_HZ") == 3
    rig.defaults()
    rig.dock.save()
    rig.reset()
    rig.alive()
    assert rig.dock.parameter("REPORT_HZ") == TABLE["REPORT_HZ"].default


def test_saving_is_acknowledged_once_it_is_done(rig: Rig) -> None:
    assert rig.command(STORE, SAVE) == dialect.MAV_RESULT_ACCEPTED
    assert rig.command(STORE, 9) == dialect.MAV_RESULT_DENIED


@pytest.mark.parametrize("rate", [5, 10])
def test_status_comes_at_the_rate_set(rig: Rig, rate: int) -> None:
    rig.dock.set_parameter("REPORT_HZ", rate)
    rig.wait("DOCK_STATUS")
    times = [rig.wait("DOCK_STATUS").time_boot_ms for _ in range(2 * rate)]
    period = statistics.median(b - a for a, b in itertools.pairwise(times))
    assert 1000 / rate <= period < 1.15 * 1000 / rate


def test_a_rate_of_zero_silences_status_but_answers_requests(rig: Rig) -> None:
    rig.dock.set_parameter("REPORT_HZ", 0)
    rig.forget()
    heard = rig.heard_until(lambda m: m.get_type() == "HEARTBEAT")
    assert "DOCK_STATUS" not in {m.get_type() for m in heard}
    assert rig.dock.status().frames > 0
