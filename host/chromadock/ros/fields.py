"""Messages as their makers and readers here have them."""

from __future__ import annotations

from typing import Any

Fields = dict[str, Any]
"""A message: its fields by name, messages in it as dictionaries too."""
