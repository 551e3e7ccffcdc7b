"""Writers of results: overlays and JSON lines, whole or not at all."""

from __future__ import annotations

from chromadock.output.base import Output, OverlayOutput
from chromadock.output.jsonlines import JsonLines, json_line
from chromadock.output.opening import open_overlay
from chromadock.output.pictures import PictureFile, PictureFolder
from chromadock.output.video import VideoOutput

__all__ = [
    "JsonLines",
    "Output",
    "OverlayOutput",
    "PictureFile",
    "PictureFolder",
    "VideoOutput",
    "json_line",
    "open_overlay",
]
