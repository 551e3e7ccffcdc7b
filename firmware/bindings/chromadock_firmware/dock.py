"""The whole dock: frames, bytes and time in; LED duties, bytes and requests out."""

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


_PREFIX = "DOCK_REQUEST_"
REQUESTS = {
    getattr(lib, name): name.removeprefix(_PREFIX).lower()
    for name in dir(lib)
    if name.startswith(_PREFIX) and name != _PREFIX + "NONE"
}


_STORED = {
    lib.SETTINGS_READ: lib.DOCK_STORED_WHOLE,
    lib.SETTINGS_MENDED: lib.DOCK_STORED_IN_PART,
    lib.SETTINGS_REFUSED: lib.DOCK_STORED_LOST,
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

    def __init__(self, settings: Settings | None = None, blob: bytes | None = None) -> None:
        """Start it with ``settings``, or with those of a ``blob`` from flash.

        A blob that is damaged leaves ``settings``; ``stored`` says what became of it.
        """
        self.c: Any = ffi.new("dock_t *")
        c = ffi.new("dock_settings_t *", (settings or Settings()).to_c())
        self.stored = lib.DOCK_STORED_WHOLE
        if blob is not None:
            self.stored = _STORED[lib.settings_from_blob(c, blob, len(blob))]
        self._buffer: Any = ffi.NULL
        lib.dock_init(self.c, c)
        self._now_ms = 0

    def frame(
        self,
        data: bytes | None,
        width: int,
        height: int,
        fmt: str,
        now_ms: int,
        age_ms: int = 0,
    ) -> None:
        """A camera frame (``fmt`` ``rgb565`` or ``rgb888``), or None: a camera fault.

        The first of its light was gathered ``age_ms`` ago: 0 for a picture of one moment.
        A frame whose length does not match its size is counted and changes nothing.
        """
        frame = ffi.NULL if data is None else c_frame(data, width, height, fmt, age_ms)
        lib.dock_frame(self.c, frame, now_ms & 0xFFFFFFFF)
        self._now_ms = now_ms

    def set_board(
        self,
        git_hash: bytes = b"",
        reset_reason: int = 0,
        capacity: int = lib.DOCK_IMAGE_BYTES,
        uid: int = 0,
    ) -> None:
        """What the board knows of itself.

        ``git_hash`` has at most 8 letters; ``capacity`` is the room in bytes for a snapshot
        or an injected frame; ``uid`` is the chip's number.
        """
        self._buffer = ffi.new("uint8_t[]", capacity) if capacity else ffi.NULL
        board = ffi.new("dock_board_t *")
        board.reset_reason = reset_reason
        board.settings = self.stored
        board.git_hash = git_hash.ljust(8, b"\0")
        board.buffer = self._buffer
        board.capacity = capacity
        board.uid = uid
        lib.dock_set_board(self.c, board)

    def set_camera(
        self, exposure: int, gain: int, locked: bool, proven: bool = False, sensor: int = 0
    ) -> None:
        """What the sensor is set to: ``exposure`` in lines, ``gain`` in its own units.

        ``proven`` says that its picture was seen to follow the lock; ``sensor`` is the product
        number of its chip, 0 for none.
        """
        camera = (exposure, gain, locked, proven, sensor)
        lib.dock_set_camera(self.c, ffi.new("dock_camera_t *", camera))

    def receive(self, data: bytes, now_ms: int) -> None:
        """Bytes from the host, in any pieces, with anything between the messages."""
        lib.dock_receive(self.c, data, len(data), now_ms & 0xFFFFFFFF)

    def transmit(self, capacity: int, now_ms: int) -> bytes:
        """Bytes for the host: as many whole messages as fit into ``capacity``."""
        out = ffi.new("uint8_t[]", capacity)
        n = lib.dock_transmit(self.c, out, capacity, now_ms & 0xFFFFFFFF)
        return bytes(ffi.buffer(out, n))

    def take_request(self) -> str | None:
        """``save``, ``camera``, ``reboot``: what only the board can do, once; or None."""
        return REQUESTS.get(lib.dock_take_request(self.c))

    def saved(self, written: bool) -> None:
        """Answer to ``save``: whether the settings are in flash now."""
        lib.dock_saved(self.c, written)

    @property
    def rest_ms(self) -> int:
        """How long the camera may rest from one frame to the next; 0: not at all."""
        return int(lib.dock_rest_ms(self.c))

    def settings_blob(self) -> bytes:
        """The settings as flash holds them."""
        blob = ffi.new("uint8_t[]", lib.SETTINGS_BLOB_BYTES)
        lib.settings_to_blob(ffi.addressof(self.c.settings), blob)
        return bytes(ffi.buffer(blob))

    def led_duties(self, now_ms: int) -> tuple[int, int, int]:
        """PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity.

        The LEDs are driven so from ``now_ms`` on: now and then they are dark for a frame.
        """
        duty = ffi.new("uint16_t[3]")
        lib.dock_led_duties(self.c, duty, now_ms & 0xFFFFFFFF)
        return duty[0], duty[1], duty[2]

    @property
    def duties(self) -> tuple[int, int, int]:
        """``led_duties`` at the time of the last frame."""
        return self.led_duties(self._now_ms)

    @property
    def looks(self) -> bool:
        """Whether the LEDs are dark so that a frame is exposed without their light."""
        return bool(lib.look_is_on(ffi.addressof(self.c.look)))

    def set_last_hue(self, hue: int) -> None:
        """The hue 0..1535 shown before a reset, for a dock whose camera gives no frame."""
        lib.dock_set_last_hue(self.c, hue)

    @property
    def marker_hue(self) -> int:
        """Hue 0..1535 that the LEDs show: the rolling mean."""
        return int(lib.dock_hue(self.c))

    @property
    def frame_faults(self) -> int:
        """Frames refused for their length, size or format."""
        return int(self.c.decision.frame_faults)
