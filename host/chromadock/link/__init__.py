"""The host's end of the MAVLink 2 link to a dock."""

from __future__ import annotations

from chromadock.link.client import DockClient
from chromadock.link.connection import Connection
from chromadock.link.discovery import open_dock

__all__ = ["Connection", "DockClient", "open_dock"]
