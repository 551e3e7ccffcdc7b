"""How the static filters are tuned: once, on simulated frames that are not evaluated.

The procedure, for the pool's and the lake's scene alike: twelve frames of the shipped scene at
1, 3 and 5 m on the headings N, E, S and W with the ternary mapping, with seeds of their own.
A marker's pixels are those in its circle (``Target``) that its light changes by at least
``MIN_CHANGE`` of 255 in any channel, against the same frame with the LEDs dark.  Each frame
that has any counts the same, however near the dock: ``SAMPLES`` pixels, evenly taken.  A box
spans from the p-th to the (100 - p)-th percentile of their hue, saturation and value; of the
``TRIMS_PERCENT`` that p is taken whose box has the best score: the mean over these frames of
the F1 score, passed pixels outside all circles being the false ones.  The threshold of the
intensity filter is the grey with the best score on both scenes' frames.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from chromadock.evaluate.tuned import Box, Tuned
from chromadock.paper.mask import HUE_STEPS, in_box

MIN_CHANGE = 26
SAMPLES = 200
TRIMS_PERCENT = (0.5, 1, 2, 5, 10, 15, 20, 25, 30, 35, 40, 45)

_Choice = TypeVar("_Choice", bound=Hashable)


@dataclass(frozen=True, eq=False)
class Example:
    """A tuning frame: OpenCV ``hsv`` (H, W, 3) and blurred ``grey`` (H, W), uint8; ``marker``
    and ``outside`` (H, W) bool: the markers' own pixels, and those outside all circles."""

    hsv: MatLike
    grey: NDArray[np.uint8]
    marker: NDArray[np.bool_]
    outside: NDArray[np.bool_]


def tune(examples: dict[str, Sequence[Example]]) -> Tuned:
    """The static filters' numbers; ``examples`` has those of each scene."""
    found = {scene: _box(of_scene) for scene, of_scene in examples.items()}
    everything = [example for of_scene in examples.values() for example in of_scene]
    grey, grey_evidence = _threshold(everything)
    evidence = {scene: evidence for scene, (_, evidence) in found.items()}
    return Tuned(
        {scene: box for scene, (box, _) in found.items()},
        grey,
        {**evidence, "grey": grey_evidence},
    )


def _box(examples: Sequence[Example]) -> tuple[Box, dict[str, Any]]:
    showing = [e for e in examples if e.marker.any()]
    if not showing:  # a box that nothing passes
        return Box((0, 255, 0), (0, 255, 0)), {"frames": 0}
    pixels = np.concatenate([_sampled(e.hsv[e.marker]) for e in showing])

    def box(trim: float) -> Box:
        ends = np.percentile(pixels[:, 1:], (trim, 100 - trim), axis=0).round().astype(int)
        (s_low, v_low), (s_high, v_high) = ends.tolist()
        hue_low, hue_high = _hue_interval(pixels[:, 0], trim)
        return Box((hue_low, s_low, v_low), (hue_high, s_high, v_high))

    boxes = {trim: box(trim) for trim in TRIMS_PERCENT}

    def passed(trim: float, example: Example) -> NDArray[np.bool_]:
        return in_box(example.hsv, boxes[trim].low, boxes[trim].high) > 0

    trim, evidence = _best(TRIMS_PERCENT, passed, showing)
    return boxes[trim], {"trim_percent": trim, **evidence}


def _threshold(examples: Sequence[Example]) -> tuple[int, dict[str, Any]]:
    showing = [e for e in examples if e.marker.any()]
    if not showing:
        return 255, {"frames": 0}
    return _best(range(1, 256), lambda grey, e: np.asarray(e.grey >= grey), showing)


def _sampled(pixels: MatLike) -> NDArray[np.int64]:
    """SAMPLES of (n, 3) pixels, evenly taken; some more than once where n is less."""
    chosen = np.linspace(0, len(pixels) - 1, SAMPLES).round().astype(int)
    return np.asarray(pixels[chosen], np.int64)


def _best(
    choices: Iterable[_Choice],
    passed: Callable[[_Choice, Example], NDArray[np.bool_]],
    examples: Sequence[Example],
) -> tuple[_Choice, dict[str, Any]]:
    """The choice with the best score, the first of equals, and how it did."""
    scores = {
        choice: np.mean([_score(passed(choice, e), e) for e in examples], axis=0)
        for choice in choices
    }
    best = max(scores, key=lambda choice: float(scores[choice][0]))
    f1, recall, precision = scores[best].round(4).tolist()
    return best, {"frames": len(examples), "f1": f1, "recall": recall, "precision": precision}


def _score(mask: NDArray[np.bool_], example: Example) -> tuple[float, float, float]:
    """F1, recall and precision of one mask; a mask that is empty is precise."""
    right = int(np.count_nonzero(mask & example.marker))
    wrong = int(np.count_nonzero(mask & example.outside))
    wanted = int(np.count_nonzero(example.marker))
    precision = right / (right + wrong) if right + wrong else 1.0
    return 2 * right / (right + wrong + wanted), right / wanted, precision


def _hue_interval(hues: NDArray[np.int64], trim: float) -> tuple[int, int]:
    """Percentiles on the circle, opposite to its mean direction cut open; the low end 0..179."""
    angles = hues * (2 * np.pi / HUE_STEPS)
    mean = np.arctan2(np.sin(angles).sum(), np.cos(angles).sum()) * HUE_STEPS / (2 * np.pi)
    half = HUE_STEPS / 2
    off = (hues - mean + half) % HUE_STEPS - half
    low, high = np.round(np.percentile(off, (trim, 100 - trim)) + mean).astype(int).tolist()
    return low % HUE_STEPS, low % HUE_STEPS + high - low
