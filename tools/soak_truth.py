"""The frames of the soak, and what a dock that sees them must show."""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from chromadock import method
from chromadock.colour.background import background_colour
from chromadock.colour.hsv import hue_cos, hue_of_vector, hue_sin, rgb_from_hsv
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import RGB565_SCALE, smooth, unpack_rgb565, working_image
from chromadock.link.rgb565 import HEIGHT, WIDTH, to_rgb565

FRAMES = 480
_KEPT_MS = 6000
_UNSURE = 2
"""The dock lights its lamps after its first frame.  Where the second one comes at once, for the
computer is late, its exposure began before that, and the dock does not decide on it."""


def write_frames(folder: Path) -> list[int]:
    """Water that goes once round the colours; returns the hue decided on each by the host's
    own code, not by the dock's."""
    hues = []
    noise = np.random.default_rng(7)
    for number in range(FRAMES):
        rgb = rgb_from_hsv(number * method.HUE_RANGE // FRAMES, 190, 170)
        image = np.empty((HEIGHT, WIDTH, 3), np.int16)
        image[:] = rgb[::-1]
        image += noise.integers(-12, 13, image.shape, np.int16)
        picture = np.clip(image, 0, 255).astype(np.uint8)
        cv2.imwrite(str(folder / f"{number:03}.png"), picture)
        pixels = unpack_rgb565(to_rgb565(picture), WIDTH, HEIGHT)
        water = background_colour(smooth(working_image(pixels, RGB565_SCALE)))
        hues.append(marker_hue(water, "ternary"))
    return hues


class Truth:
    """Judges each DOCK_STATUS of a dock that sees ``hues`` again and again from its start.

    Attributes
    ----------
    wrong
        A line for each status that is not as it must be.
    shown
        Time in ms, rolling mean and duties of the newest ones.
    """

    def __init__(self, hues: list[int]) -> None:
        self._hues = hues
        self._cos = np.concatenate([[0], np.cumsum(hue_cos(np.array(hues, np.int32)))])
        self._sin = np.concatenate([[0], np.cumsum(hue_sin(np.array(hues, np.int32)))])
        self.shown: deque[tuple[int, int, int, tuple[int, ...]]] = deque()
        self.checked = 0
        self.wrong: list[str] = []
        self.longest_gap_ms = 0
        self.link_faults = 0

    def take(self, status: Any) -> None:
        """The next status, as the dock sent it."""
        now, frames = status.time_boot_ms, status.frames
        duties = tuple(status.duty)
        if self.shown:
            gap = now - self.shown[-1][0]
            self.longest_gap_ms = max(self.longest_gap_ms, gap)
            if gap < 0:
                self.wrong.append(f"{now} ms: it restarted")
        self.shown.append((now, frames, status.marker_hue, duties))
        while now - self.shown[0][0] > _KEPT_MS:
            self.shown.popleft()
        self.link_faults = status.link_faults
        if frames == 0:
            return
        self.checked += 1
        decided = self._hues[(frames - 1) % len(self._hues)]
        if status.decided_hue != decided:
            self.wrong.append(f"{now} ms: decided {status.decided_hue}, not {decided}")
        if status.led_mode != 0:
            self.wrong.append(f"{now} ms: LED mode {status.led_mode}")
        means = {m for count in self._window(now, frames) for m in self._means(frames, count)}
        if status.marker_hue not in means:
            self.wrong.append(f"{now} ms: mean {status.marker_hue}, not of {sorted(means)}")
        if duties != _duties(status.marker_hue):
            self.wrong.append(f"{now} ms: duties {duties} for hue {status.marker_hue}")

    def _window(self, now: int, frames: int) -> range:
        """How many decisions the rolling mean may hold: from the reports of 2 s ago.

        The last decision came after the newest report with fewer frames and not after ``now``.
        """
        window = method.WINDOW_MS
        earlier = [t for t, n, *_ in self.shown if n < frames]
        latest_start = now - window
        earliest_start = (earlier[-1] if earlier else 0) - window
        surely_out = max((n for t, n, *_ in self.shown if t <= earliest_start), default=0)
        if self.shown[0][0] > earliest_start and self.shown[0][1] > 0:
            surely_out = max(0, frames - method.WINDOW_CAPACITY)
        surely_in = next((n for t, n, *_ in self.shown if t >= latest_start), frames - 1)
        most = min(frames - surely_out, method.WINDOW_CAPACITY)
        return range(max(1, min(frames - surely_in, most)), most + 1)

    def _means(self, frames: int, count: int) -> set[int | None]:
        """Circular mean of the decisions on the last ``count`` frames.

        Where frame ``_UNSURE`` is one of them there are two means, with it and without: whether it
        was decided on cannot be told from outside, for reports have no exposure times.
        """
        x = self._sum(self._cos, frames) - self._sum(self._cos, frames - count)
        y = self._sum(self._sin, frames) - self._sum(self._sin, frames - count)
        means = {hue_of_vector(x, y)}
        if frames - count < _UNSURE <= frames:
            hue = np.array(self._hues[_UNSURE - 1], np.int32)
            means.add(hue_of_vector(x - int(hue_cos(hue)), y - int(hue_sin(hue))))
        return means

    def _sum(self, sums: np.ndarray, frames: int) -> int:
        rounds, rest = divmod(frames, len(self._hues))
        return int(rounds * sums[-1] + sums[rest])


def _duties(hue: int) -> tuple[int, ...]:
    from chromadock_firmware import Settings, ffi, lib

    duty = ffi.new("uint16_t[3]")
    settings = Settings().to_c()
    lib.led_duties(duty, hue, ffi.addressof(settings, "led"))
    return tuple(duty)
