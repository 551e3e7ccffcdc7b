"""The numbers of the filters that do not adapt."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

HSV = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Box:
    """OpenCV HSV from ``low`` to ``high``, both included; a hue below 0 wraps."""

    low: HSV
    high: HSV


@dataclass(frozen=True, slots=True)
class Tuned:
    """A box for each tuning scene, the least grey 0..255, and how they came about."""

    boxes: Mapping[str, Box]
    grey: int
    evidence: Mapping[str, Mapping[str, Any]]

    def to_dict(self) -> dict[str, Any]:
        """As JSON can hold it."""
        content: dict[str, Any] = json.loads(json.dumps(asdict(self)))
        return content

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Tuned:
        """The inverse of ``to_dict``."""
        boxes = {
            scene: Box(tuple(box["low"]), tuple(box["high"]))
            for scene, box in content["boxes"].items()
        }
        return cls(boxes, content["grey"], content["evidence"])
