"""What a DOCK_STATUS says, for people: in a table, or in a line."""

from __future__ import annotations

from typing import Any

from rich.table import Table
from rich.text import Text

from chromadock import dialect
from chromadock.colour.hsv import degrees, rgb_from_hsv

NO_HUE = 0xFFFF
_FAULTS = {
    dialect.DOCK_FAULT_CAMERA: "camera gives no frame",
    dialect.DOCK_FAULT_FRAME: "broken frame",
    dialect.DOCK_FAULT_SETTINGS: "stored settings were corrupt",
    dialect.DOCK_FAULT_STORAGE: "settings cannot be saved",
    dialect.DOCK_FAULT_UNLOCKED: "camera not locked yet",
    dialect.DOCK_FAULT_OWN_LIGHT: "camera sees the dock's own lamps",
}
_SENSORS = {
    0x26: "OV2640",
    0x3660: "OV3660, unproven: no board with it has been tried",
    0x5640: "OV5640, unproven: no board with it has been tried",
    0x2145: "GC2145, unfit: its driver cannot lock it",
}
_LOCKS = {
    dialect.DOCK_LOCK_NONE: "no",
    dialect.DOCK_LOCK_READ_BACK: "by its registers alone",
    dialect.DOCK_LOCK_PROVEN: "yes, the picture followed",
}
_LED_MODES = {
    dialect.DOCK_LED_AUTO: "auto",
    dialect.DOCK_LED_HUE: "fixed hue",
    dialect.DOCK_LED_RAW: "raw duties",
}


def faults(status: Any) -> str:
    """What is wrong now, or ``none``."""
    words = [text for bit, text in _FAULTS.items() if status.faults & bit]
    rest = status.faults & ~sum(_FAULTS)
    return ", ".join([*words, f"unknown {rest:#x}"] if rest else words) or "none"


def sensor(status: Any) -> str:
    """The camera's sensor by name, and what is known of it."""
    if not status.sensor:
        return "none, or a firmware that does not tell"
    unknown = f"unknown {status.sensor:#x}, unproven: the dock is made for an OV2640"
    return _SENSORS.get(status.sensor, unknown)


def hue(steps: int) -> str:
    """A hue of 1536 steps in degrees, or a dash."""
    return "-" if steps == NO_HUE else f"{degrees(steps):.1f}°"


def marker_rgb(status: Any) -> tuple[int, int, int]:
    """The pure colour of the rolling mean's hue; black before the first decision."""
    return rgb_from_hsv(status.marker_hue % 1536, 255, 255) if status.frames else (0, 0, 0)


def line(status: Any) -> str:
    """The essentials in one line."""
    r, g, b = status.background_rgb
    red, green, blue = status.duty
    return (
        f"{status.time_boot_ms / 1000:10.1f} s  {status.frame_rate_dhz / 10:4.1f} fps  "
        f"water {hue(status.background_hue)} #{r:02x}{g:02x}{b:02x} "
        f"confidence {status.confidence / 255:.2f}  marker {hue(status.marker_hue)}  "
        f"duties {red} {green} {blue}  exposure {status.exposure} gain {status.gain}  "
        f"faults: {faults(status)}"
    )


def table(status: Any, title: str) -> Table:
    """All of it, with swatches of both colours."""
    rows = Table(title=title, show_header=False, box=None, pad_edge=False)
    rows.add_column(style="bold")
    rows.add_column()
    water, marker = tuple(status.background_rgb), marker_rgb(status)
    rows.add_row("water", _swatch(water, hue(status.background_hue)))
    rows.add_row("confidence", f"{status.confidence / 255:.2f}")
    rows.add_row("marker", _swatch(marker, hue(status.marker_hue)))
    rows.add_row("decided last", hue(status.decided_hue))
    rows.add_row("duties R G B", " ".join(map(str, status.duty)))
    rows.add_row("LEDs", _LED_MODES.get(status.led_mode, str(status.led_mode)))
    rows.add_row("rate", f"{status.frame_rate_dhz / 10:.1f} fps, {status.frames} frames")
    rows.add_row("sensor", sensor(status))
    rows.add_row("locked", _LOCKS.get(status.lock, str(status.lock)))
    rows.add_row("exposure, gain", f"{status.exposure} lines, {status.gain}")
    wrong = faults(status)
    rows.add_row("faults", Text(wrong, style="" if wrong == "none" else "bold red"))
    rows.add_row(
        "refused",
        f"{status.camera_faults} camera, {status.frame_faults} frames, "
        f"{status.link_faults} messages",
    )
    rows.add_row("running for", f"{status.time_boot_ms / 1000:.1f} s")
    return rows


def _swatch(rgb: tuple[int, ...], text: str) -> Text:
    r, g, b = rgb
    return Text.assemble(("      ", f"on rgb({r},{g},{b})"), f" #{r:02x}{g:02x}{b:02x}  {text}")
