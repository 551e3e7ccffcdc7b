"""When each row of a frame is taken."""

from __future__ import annotations

from dataclasses import dataclass

_BANDS = 8


@dataclass(frozen=True)
class Shutter:
    """Rows are read from the top at equal intervals; a frame's time is that of its middle.

    Parameters
    ----------
    height
        Rows.
    readout_s
        From the first row to the last; 0 is a global shutter.
    """

    height: int
    readout_s: float

    def row_time(self, time_s: float, row: float) -> float:
        """When a row, 0 the topmost, of the frame of ``time_s`` is taken; rows beyond too."""
        return time_s + self.readout_s * (row / (self.height - 1) - 0.5)

    def bands(self, multiple: int) -> list[range]:
        """Rows that may be drawn as of one moment, each a multiple of so many rows but the last."""
        if not self.readout_s:
            return [range(self.height)]
        size = -(-self.height // (_BANDS * multiple)) * multiple
        starts = range(0, self.height, size)
        return [range(start, min(start + size, self.height)) for start in starts]
