from __future__ import annotations

from typing import Any

import budgets
from bench_memory import resident_mib


def test_detecting_in_a_vga_video_stays_within_the_memory_budget(record_property: Any) -> None:
    resident = resident_mib()
    record_property("figure", f"chromadock detect on VGA video: {resident:.0f} MiB resident")
    assert 10 < resident < budgets.RESIDENT_MIB
