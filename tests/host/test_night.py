"""The dock in twilight, in fast time; `make night` has the whole nights."""

from __future__ import annotations

from collections.abc import Callable

import night
import pytest


@pytest.mark.parametrize("own", night.OWN_LIGHT)
@pytest.mark.parametrize("mapping", night.MAPPINGS)
def test_twenty_minutes_of_dusk_with_own_light_and_a_lamp_that_passes(
    own: float, mapping: str, record_property: Callable[[str, object], None]
) -> None:
    result = night.run(12, "sea", own, mapping, night.TWILIGHT)
    record_property(
        "figure",
        f"dusk, own light {100 * own:g} %, {mapping}: {result.worst_deg:.1f} deg off at most, "
        f"{100 * result.lost:.2f} % dark, {result.longest_s:.3f} s at a stretch",
    )
    assert result.worst_deg <= night.MOST_DEG
    assert 0 < result.longest_s <= night.MOST_DARK_S
    assert 0 < result.lost <= night.MOST_LOST
    assert 300 < result.hues < 1100  # it is day at first and night at last


def test_a_dock_that_believed_every_frame_would_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scene has the fault in it that is mended."""
    frame = night.Dock.frame

    def believing(self: night.Dock, *arguments: object) -> None:
        frame(self, *arguments)  # type: ignore[arg-type]
        self.c.look.clear = True
        self.c.look.pause_ms = 2**31

    monkeypatch.setattr(night.Dock, "frame", believing)
    result = night.run(12, "sea", 0.003, "ternary", night.TWILIGHT)
    assert result.worst_deg > 20
