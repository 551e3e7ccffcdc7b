"""Writes docs/configuration.md from the keys of the vehicle's file; `make generate` runs it."""

from __future__ import annotations

from pathlib import Path

from chromadock.vehicle.manual import page

PAGE = Path(__file__).resolve().parents[1] / "docs" / "configuration.md"


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
