from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    vectors: dict[str, Any] = json.loads((ROOT / "shared/vectors/golden.json").read_text())
    vectors["pixels"] = (ROOT / "shared/vectors/frames.bin").read_bytes()
    return vectors
