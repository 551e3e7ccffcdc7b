"""Reads the JUnit reports that PlatformIO and pytest write."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

from step import Outcome


def read_report(report: Path) -> Outcome:
    """Count the cases of a report.

    A test shows a measured figure at the end of `make test` by pytest's
    ``record_property("figure", "recall at 2 m: 24 of 26")``.
    """
    outcome = Outcome()
    if not report.is_file():
        return outcome
    for case in ElementTree.parse(report).iter("testcase"):
        skipped = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            outcome.failed += 1
        elif skipped is not None:
            place = case.get("file") or case.get("classname") or ""
            reason = skipped.get("message") or "no reason given"
            outcome.skips.append((f"{place}:{case.get('name')}", reason))
        else:
            outcome.passed += 1
        outcome.figures += [
            str(entry.get("value"))
            for entry in case.iter("property")
            if entry.get("name") == "figure"
        ]
    return outcome
