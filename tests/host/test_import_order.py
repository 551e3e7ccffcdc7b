"""Imports of the host run one way: from results to the detector, and in no circle."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import chromadock

ROOT = Path(chromadock.__file__).parent
ROOMS = "robust"
"""The folder whose own folders and files are parts by themselves."""

ORDER = (
    "results",
    "geometry",
    "robust.frame",
    "robust.weigh",
    "robust.find",
    "robust.method",
    "track",
    "detector",
)
"""Each may import those before it, and none after it."""


def imported(body: list[ast.stmt]) -> Iterator[str]:
    """Modules named by the imports of statements; not of functions, which run later."""
    for statement in body:
        if isinstance(statement, ast.ImportFrom) and statement.module:
            yield from (f"{statement.module}.{alias.name}" for alias in statement.names)
        elif isinstance(statement, ast.Import):
            yield from (alias.name for alias in statement.names)
        elif isinstance(statement, ast.If | ast.Try):
            yield from imported([*statement.body, *statement.orelse])


def part_of(names: Sequence[str]) -> str:
    """The part that a module belongs to, by the names that lead to it from the package."""
    return ".".join(names[: 2 if names[0] == ROOMS else 1])


def graph() -> dict[str, set[str]]:
    """Parts of the package, a folder or a file directly in it, and the parts that each imports,
    for type checkers too."""
    parts: dict[str, set[str]] = {}
    for path in sorted(ROOT.rglob("*.py")):
        part = part_of(path.relative_to(ROOT).with_suffix("").parts)
        names = [n.split(".") for n in imported(ast.parse(path.read_text("utf-8")).body)]
        others = {part_of(n[1:]) for n in names if n[0] == "chromadock" and len(n) > 1} - {part}
        parts.setdefault(part, set()).update(others)
    # The package's own file names for type checkers what others find there.
    del parts["__init__"]
    return {part: others & parts.keys() for part, others in parts.items()}


def test_no_part_imports_itself_by_way_of_others() -> None:
    try:
        TopologicalSorter(graph()).prepare()
    except CycleError as error:
        raise AssertionError(" -> ".join(error.args[1])) from None


def test_the_layers_of_the_detector_import_downwards_only() -> None:
    parts = graph()
    for k, layer in enumerate(ORDER):
        seen, waiting = set[str](), [layer]
        while waiting:
            part = waiting.pop()
            if part not in seen:
                seen.add(part)
                waiting += parts[part]
        assert not seen.intersection(ORDER[k + 1 :]), layer
