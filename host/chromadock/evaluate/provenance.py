"""Where the frames of an evaluation come from: seeds, digests and versions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import polars as pl
from pydantic import BaseModel, ValidationError

from chromadock.errors import ChromadockError
from chromadock.evaluate.summary import FRAME
from chromadock.text import plural

FILE = "evaluation.json"


class Origin(BaseModel):
    """Of one experiment: its seed and the digest of all that its frames are made from."""

    seed: int
    digest: str


class Provenance(BaseModel):
    """The content of ``evaluation.json``: experiments by name, versions by what has one."""

    experiments: dict[str, Origin]
    versions: dict[str, str]


@dataclass(frozen=True)
class Source:
    """An experiment with the numbers of its runs and frames."""

    name: str
    runs: int
    frames: int
    origin: Origin


def read_provenance(out: Path) -> Provenance:
    """What the evaluation in ``out`` says of itself.

    Raises
    ------
    ChromadockError
        Where it does not say it.
    """
    path = out / FILE
    try:
        return Provenance.model_validate_json(path.read_bytes())
    except OSError as error:
        raise ChromadockError(
            f"{path}: cannot be read ({error.strerror}): evaluate again"
        ) from None
    except ValidationError:
        raise ChromadockError(f"{path}: not what an evaluation writes: evaluate again") from None


def sources(provenance: Provenance, frames: pl.DataFrame) -> list[Source]:
    """The experiments that the frames are from."""
    return [
        Source(
            name,
            rows["run"].n_unique(),
            rows.n_unique(FRAME),
            provenance.experiments[name],
        )
        for (name,), rows in frames.group_by("experiment", maintain_order=True)
    ]


def source_line(provenance: Provenance, frames: pl.DataFrame) -> str:
    """All of it about a figure in one line."""
    parts = [
        f"{each.name}: {plural(each.runs, 'run')}, {each.frames:,} frames, "
        f"seed {each.origin.seed}, digest {each.origin.digest}"
        for each in sources(provenance, frames)
    ]
    return f"{'; '.join(parts)}. {versions_line(provenance)}."


def versions_line(provenance: Provenance) -> str:
    """What computed the frames."""
    return ", ".join(f"{name} {version}" for name, version in provenance.versions.items())
