"""What the commands that work by a vehicle's settings have in common."""

from __future__ import annotations

from typing import Annotated, Any

import typer

_EXAMPLE = "dock.mapping=contrast"

Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help=f"Takes precedence over a key of the settings, e.g. {_EXAMPLE}; may be repeated.",
        show_default=False,
    ),
]
DryRun = Annotated[
    bool,
    typer.Option("--dry-run", help="Send an autopilot nothing: say what it would understand."),
]
JsonLines = Annotated[bool, typer.Option("--json", help="Print one JSON object a frame.")]


def changes_of(texts: list[str] | None) -> dict[str, Any]:
    """What ``--set`` changes, by key.

    Raises
    ------
    ChromadockError
        Where a text is not KEY=VALUE.
    """
    from chromadock.toml_file import change

    return dict(change(text, _EXAMPLE) for text in texts or [])
