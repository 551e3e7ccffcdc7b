"""How long to wait before what failed is tried again: a camera, a port, a disk."""

from __future__ import annotations

FIRST_RETRY_S = 0.5
LONGEST_RETRY_S = 10.0
"""Each wait is twice the one before, up to the longest: quick enough for a cable that was pulled
out for a moment, and no burden for a network that is down for an hour."""
