"""What the paper says of its experiments, beside what this run of them came to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import polars as pl

from chromadock.evaluate import formats
from chromadock.evaluate.filters import STATIC
from chromadock.evaluate.summary import (
    MISMATCHED,
    TERNARY,
    Estimate,
    hue_disagreement,
    pixel_ratio,
    share,
)

COMPLEMENT = "adaptive complement"

OVER = 10.0
SOMETIMES = 0.1
NEARLY_DEG = 10.0
ALMOST_NOTHING = 0.001


@dataclass(frozen=True)
class Claim:
    """``name`` picks the explanation in the template, for where the two disagree."""

    name: str
    paper: str
    here: str
    agrees: bool


def claims(lake: pl.DataFrame, pool: pl.DataFrame) -> list[Claim]:
    """One for each sentence of the paper's results that a figure can be put to."""
    return [
        *_static(lake, pool),
        _selective(lake, pool),
        *_reach(lake, pool),
        _agreement(lake, pool),
        *_mappings(pool),
    ]


def _static(lake: pl.DataFrame, pool: pl.DataFrame) -> Iterator[Claim]:
    for name, rows in (("lake", lake), ("pool", pool.filter(pl.col("mapping") == "ternary"))):
        found = pixel_ratio(rows, MISMATCHED[name])
        assert found is not None
        yield Claim(
            f"static-{name}",
            f"In the {name} a static filter tuned to other water passes over ×{OVER:g} the "
            "pixels of ternary.",
            f"{formats.ratio(found.ratio)}; ternary finds the dock in "
            f"{formats.percent(_recall(rows))} of the frames",
            found.ratio.value > OVER,
        )
    ratios = {}
    for filter_, water in STATIC.items():
        tuned, other = (lake, pool) if water == "lake" else (pool, lake)
        ratios[filter_] = mean_passed(other, filter_) / max(mean_passed(tuned, filter_), 1e-12)
    yield Claim(
        "tuned",
        "Static filters do well in the water they are tuned to and are orders of magnitude worse "
        "elsewhere.",
        ", ".join(f"{name}: {formats.times(value)} elsewhere" for name, value in ratios.items()),
        min(ratios.values()) > OVER,
    )


def _selective(lake: pl.DataFrame, pool: pl.DataFrame) -> Claim:
    compared = [TERNARY, *STATIC]
    medians = (
        pl.concat([lake, pool])
        .filter(pl.col("filter").is_in(compared))
        .group_by("run", "filter")
        .agg(pl.col("passed").median())
        .pivot("filter", index="run", values="passed")
    )
    best = medians.filter(pl.col(TERNARY) <= pl.min_horizontal(*STATIC)).height
    return Claim(
        "selective",
        "Ternary is the most selective in every run, static filters included.",
        f"in {best} of {medians.height} runs",
        best == medians.height,
    )


def _reach(lake: pl.DataFrame, pool: pl.DataFrame) -> Iterator[Claim]:
    far = _recall(pool, 5.0)
    yield Claim(
        "reach-pool",
        "In the pool the dock is detected at 5 m.",
        f"in {formats.percent(far)} of the frames",
        far is not None and far.value >= SOMETIMES,
    )
    near, beyond = _recall(lake, 1.0), _recall(lake, 3.0)
    yield Claim(
        "reach-lake",
        "In the lake it is detected at 1 m, and nothing of it is seen past 2 m.",
        f"in {formats.percent(near)} of the frames at 1 m, {formats.percent(beyond)} at 3 m",
        near is not None
        and beyond is not None
        and near.value >= SOMETIMES
        and beyond.value < SOMETIMES,
    )


def _agreement(lake: pl.DataFrame, pool: pl.DataFrame) -> Claim:
    medians = [
        hue.value for rows in (lake, pool) for _, hue in hue_disagreement(rows, ["distance_m"])
    ]
    return Claim(
        "agreement",
        "Dock and vehicle decide on nearly the same colour.",
        f"median {formats.number(min(medians))} to {formats.number(max(medians))}° apart, by water "
        "and distance",
        max(medians) <= NEARLY_DEG,
    )


def _mappings(pool: pl.DataFrame) -> Iterator[Claim]:
    ternary, complement = mean_passed(pool, TERNARY), mean_passed(pool, COMPLEMENT)
    yield Claim(
        "complement",
        "The complement's filter lets parts of the dock through, buoys, struts and printed ones, "
        "and so more than ternary's.",
        f"{formats.plain_percent(complement)} of the pool's pixels against "
        f"{formats.plain_percent(ternary)}",
        complement > ternary,
    )
    other = mean_passed(pool.filter(pl.col("mapping") == "complement"), TERNARY)
    yield Claim(
        "nothing",
        "Where the dock shows the complement, almost nothing passes ternary's filter.",
        f"{formats.plain_percent(other)} of the pixels",
        other < ALMOST_NOTHING,
    )


def mean_passed(rows: pl.DataFrame, name: str) -> float:
    """Share of all pixels of all frames that a filter passes."""
    return float(rows.filter(pl.col("filter") == name)["passed"].to_numpy().mean())


def _recall(rows: pl.DataFrame, distance_m: float | None = None) -> Estimate | None:
    """Of ternary where the dock shows it, at one distance or at all."""
    wanted = (pl.col("filter") == TERNARY) & (pl.col("mapping") == "ternary")
    if distance_m is not None:
        wanted &= pl.col("distance_m") == distance_m
    return share(rows.filter(wanted & pl.col("markers_in_view")), "correct")
