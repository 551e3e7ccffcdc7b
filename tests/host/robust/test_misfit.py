"""What stands like the dock is told as a misfit only where it does not fit."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from chromadock.robust.find.measure import Measure

MUCH = 20 * np.log(10)
NOTHING = cast(Any, None)


@pytest.mark.parametrize(
    ("evidence", "error_px", "told"),
    [(MUCH, 9.0, True), (MUCH, 0.3, False), (MUCH / 4, 9.0, False)],
)
def test_only_errors_beyond_those_of_the_places_are_a_misfit(
    evidence: float, error_px: float, told: bool
) -> None:
    """Else the command line would say "0 pixels off: check the calibration"."""
    measure = Measure(NOTHING, NOTHING, NOTHING, NOTHING, 1 + 0j, np.inf, NOTHING)
    measure._note(evidence, error_px, np.full(4, 0.4))
    assert [m.error_px for m in measure.misfits] == ([error_px] if told else [])
