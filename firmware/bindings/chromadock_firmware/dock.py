"""The whole dock: frames and time in, LED duties out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from chromadock_firmware._dockcore import ffi, lib
from chromadock_firmware.frames import c_frame

_PREFIX = "METHOD_MAPPING_"
MAPPINGS = {
    name.removeprefix(_PREFIX).lower(): getattr(lib, name)
    for name in dir(lib)
    if name.startswith(_PREFIX) and name not in (_PREFIX + "COUNT", _PREFIX + "TURN")
}


@dataclass(frozen=True, slots=True)
class Settings:
    """What differs from the firmware's default settings; None leaves the default."""

    mapping: str | None = None
    fallback_hue: int | None = None
    window_ms: int | None = None
    led_offset: tuple[int, int, int] | None = None
    led_matrix: tuple[int, ...] | None = None
    led_gamma: int | None = None
    led_limit: int | None = None
    led_common_anode: bool | None = None

    def to_c(self) -> Any:
        """``dock_settings_t`` by value."""
        c = lib.dock_default_settings()
        if self.mapping is not None:
            c.mapping = MAPPINGS[self.mapping]
        for name in ("fallback_hue", "window_ms"):
            if getattr(self, name) is not None:
                setattr(c, name, getattr(self, name))
        for name in ("offset", "matrix", "gamma", "limit", "common_anode"):
            if getattr(self, f"led_{name}") is not None:
                setattr(c.led, name, getattr(self, f"led_{name}"))
        return c


class Dock:
    """A dock in memory of its own; any number may run side by side."""

    def __init__(self, settings: Settings | None = None) -> None:
        self.c: Any = ffi.new("dock_t *")
        lib.dock_init(self.c, ffi.new("dock_settings_t *", (settings or Settings()).to_c()))

    def frame(self, data: bytes | None, width: int, height: int, fmt: str, now_ms: int) -> None:
        """A camera frame (``fmt`` ``rgb565`` or ``rgb888``), or None: a camera fault.

        A frame whose length does not match its size is counted and changes nothing.
        """
        frame = ffi.NULL if data is None else c_frame(data, width, height, fmt)
        lib.dock_frame(self.c, frame, now_ms & 0xFFFFFFFF)

    @property
    def duties(self) -> tuple[int, int, int]:
        """PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity."""
        duty = ffi.new("uint16_t[3]")
        lib.dock_led_duties(self.c, duty)
        return duty[0], duty[1], duty[2]

    @property
    def marker_hue(self) -> int:
        """Hue 0..1535 that the LEDs show: the rolling mean."""
        return int(self.c.marker_hue)

    @property
    def frame_faults(self) -> int:
        """Frames refused for their length, size or format."""
        return int(self.c.counters.frame_faults)
