"""Where results go: overlays and files, whole or not at all; logs, the network, an autopilot."""

from __future__ import annotations

from chromadock.output.addresses import Surroundings, open_output
from chromadock.output.base import Output, OverlayOutput
from chromadock.output.guarded import Guarded
from chromadock.output.jsonlines import JsonLines, json_line
from chromadock.output.opening import open_overlay
from chromadock.output.pictures import PictureFile, PictureFolder
from chromadock.output.results import ResultOutput, result_record
from chromadock.output.video import VideoOutput

__all__ = [
    "Guarded",
    "JsonLines",
    "Output",
    "OverlayOutput",
    "PictureFile",
    "PictureFolder",
    "ResultOutput",
    "Surroundings",
    "VideoOutput",
    "json_line",
    "open_output",
    "open_overlay",
    "result_record",
]
