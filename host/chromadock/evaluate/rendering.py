"""Templates and what they may call."""

from __future__ import annotations

from collections.abc import Sequence

from jinja2 import BaseLoader, Environment, PackageLoader, StrictUndefined

from chromadock.evaluate import formats
from chromadock.evaluate.gallery import Exhibit
from chromadock.evaluate.style import LOOKS


def environment(loader: BaseLoader | None = None, *, markup: bool = True) -> Environment:
    """For templates of this package or of ``loader``; ``markup`` escapes what is put in."""
    made = Environment(
        loader=loader or PackageLoader("chromadock.evaluate"),
        autoescape=markup,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters.update(formats.FILTERS, label=lambda name: LOOKS[name].label)
    return made


def gallery_svg(exhibits: Sequence[Exhibit]) -> str:
    """The exhibits below each other in one SVG."""
    return environment().get_template("gallery.svg").render(exhibits=exhibits)
