"""Frames from anywhere: a camera, a video, pictures, a pipeline, a URL; one interface."""

from __future__ import annotations

from chromadock.sources.base import Frame, OnFault, Source, ignore
from chromadock.sources.opening import open_source

__all__ = ["Frame", "OnFault", "Source", "ignore", "open_source"]
