"""The firmware core's files call each other one way."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "firmware" / "lib" / "dockcore" / "src"
HEADERS = ROOT / "build" / "mavlink" / "c"


def symbols(source: Path, folder: Path) -> tuple[set[str], set[str]]:
    """What a file defines, and what it takes from elsewhere."""
    out = folder / f"{source.stem}.o"
    flags = ["-std=c11", "-c", f"-I{CORE}", "-isystem", HEADERS]
    subprocess.run(["cc", *flags, source, "-o", out], check=True)
    lines = subprocess.run(["nm", out], check=True, capture_output=True, text=True).stdout
    rows = [line.split()[-2:] for line in lines.splitlines()]
    defined = {name for kind, name in rows if kind in "TDBRC"}
    return defined, {name for kind, name in rows if kind == "U"}


@pytest.fixture(scope="module")
def uses(tmp_path_factory: pytest.TempPathFactory) -> dict[str, set[str]]:
    """For each file of the core, the files that it calls or whose tables it reads."""
    folder = tmp_path_factory.mktemp("objects")
    subprocess.run([sys.executable, ROOT / "shared" / "mavlink.py"], check=True)
    sources = sorted(CORE.glob("*.c"))
    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(lambda source: symbols(source, folder), sources))
    owner = {
        name: source.stem
        for source, (defined, _) in zip(sources, found, strict=True)
        for name in defined
    }
    return {
        source.stem: {owner[name] for name in needed if name in owner}
        for source, (_, needed) in zip(sources, found, strict=True)
    }


def test_no_file_is_called_by_one_that_it_calls(uses: dict[str, set[str]]) -> None:
    try:
        order = list(TopologicalSorter(uses).static_order())
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))
    assert order[-1] == "dock"


def test_the_decision_knows_nothing_of_the_link(uses: dict[str, set[str]]) -> None:
    for name in ("decision", "lamps", "requests", "settings", "receiver"):
        assert not any(used.startswith("link") for used in uses[name]), name
    assert {name for name, used in uses.items() if "dock" in used} == set()
