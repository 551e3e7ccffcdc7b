"""The golden vectors of shared/, and the way to inject a frame of them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from rig import Message, Rig, handshake
from targets import ROOT

from chromadock import dialect
from chromadock.link import pictures

_VECTORS = ROOT / "shared" / "vectors"
_KINDS = {"rgb565": pictures.RGB565, "rgb888": pictures.RGB888}
MOST_BYTES = 38400
"""A frame of the dock's own camera; a board has no room for more."""


@dataclass(frozen=True)
class Frame:
    """A frame and what the reference decided on it."""

    name: str
    width: int
    height: int
    kind: int
    data: bytes
    mapping: str
    background: dict[str, Any]
    marker_hue: int
    duties: list[int]

    @property
    def messages(self) -> tuple[Message, list[Message]]:
        """Announcement and packets."""
        size = pictures.PAYLOAD
        pieces = [self.data[i : i + size] for i in range(0, len(self.data), size)]
        return (
            handshake(self.kind, len(self.data), self.width, self.height, len(pieces)),
            [
                dialect.MAVLink_encapsulated_data_message(i, piece.ljust(size, b"\0"))
                for i, piece in enumerate(pieces)
            ],
        )


def _read() -> dict[str, Frame]:
    pixels = (_VECTORS / "frames.bin").read_bytes()
    records = json.loads((_VECTORS / "golden.json").read_text())["frames"]
    return {
        r["name"]: Frame(
            r["name"],
            r["width"],
            r["height"],
            _KINDS[r["format"]],
            pixels[r["frame_at"] :][: r["frame_bytes"]],
            r["mapping"],
            r["background"],
            r["marker_hue"],
            r["duties"],
        )
        for r in records
    }


FRAMES = _read()
FITTING = [name for name, frame in FRAMES.items() if len(frame.data) <= MOST_BYTES]


def hold(rig: Rig, frame: Frame) -> int:
    """Announce ``frame`` and wait until only it counts in the rolling mean.

    From the announcement on the dock passes over its camera's frames.  Returns the
    count of frames decided on so far.
    """
    rig.dock.set_parameter("WINDOW_MS", 100)
    rig.send(frame.messages[0])
    echo = rig.wait("DATA_TRANSMISSION_HANDSHAKE")
    assert (echo.size, echo.width, echo.height) == (len(frame.data), frame.width, frame.height)
    first = rig.dock.status()
    return int(rig.status(lambda s: s.time_boot_ms >= first.time_boot_ms + 100).frames)


def inject(rig: Rig, frame: Frame) -> Message:
    """The DOCK_STATUS that the dock sends for an injected frame alone."""
    before = hold(rig, frame)
    rig.send(*frame.messages[1])
    return rig.wait("DOCK_STATUS", lambda s: s.frames == before + 1)
