"""Frames from anywhere: a camera, a video, pictures, a pipeline, a URL; one interface."""

from __future__ import annotations

from chromadock.sources.base import Frame, OnSkip, Source, ignore
from chromadock.sources.opening import open_source

__all__ = ["Frame", "OnSkip", "Source", "ignore", "open_source"]
