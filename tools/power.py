"""Computes what a dock draws from its supply, for docs/power.md: .venv/bin/python tools/power.py.

Nothing here was measured.  Every figure of a part is of its data sheet.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "docs" / "power.md"
BEGIN, END = "<!-- Written by tools/power.py. -->\n", "<!-- End of what it writes. -->\n"
SUPPLY_V = 5.0


@dataclass(frozen=True)
class Range:
    """Current in mA, the least and the most."""

    least: float
    most: float

    def __add__(self, other: Range) -> Range:
        """Of two parts together."""
        return Range(self.least + other.least, self.most + other.most)

    def __mul__(self, share: float) -> Range:
        """Mean of a part that draws this for a share of the time."""
        return Range(share * self.least, share * self.most)

    def __str__(self) -> str:
        """For the table."""
        return f"{self.least:.0f} to {self.most:.0f}"


# ESP32 Series Datasheet, "Current Consumption Characteristics": modem-sleep, which is the radio
# off, both cores; the least idle, the most at work.
PROCESSOR_240 = Range(30, 68)
PROCESSOR_80 = Range(20, 31)
# OV2640 data sheet, "Key Specifications": 125 mW active (15 fps, UXGA, YUV), 600 uA in standby.
# By linear regulators, so that the current is that of the rails, 1.3 V (core) to 2.8 V.
SENSOR_MW = 125.0
SENSOR = Range(SENSOR_MW / 2.8, SENSOR_MW / 1.3)
SENSOR_STANDBY = Range(0.6, 0.6)
# AMS1117 data sheet: quiescent current, typical and most.
REGULATOR = Range(5, 11)

# Frames of a decision: until the sensor shows the new ones, the one decided on, and the two that
# fill the driver's buffers before it stands still (firmware/esp32cam/camera.cpp).
AWAKE_FRAMES = 3 + 1 + 2
FRAME_S = 0.1  # a frame every 80 to 160 ms is expected
# docs/hardware.md: four LEDs on MOSFETs, red 20 mA and green or blue 18 mA each, both full.
LEDS_MA = 4 * (20 + 18)
DARK_LIMIT = 64  # an example
INTERVALS_MS = (0, 1000, 2000, 5000, 10000)


def board(interval_ms: int) -> Range:
    """Mean current of the board without its LEDs, a decision every ``interval_ms``; 0: all frames.

    The interval counts from a frame to the end of the rest; then come the frames of waking.
    """
    working = PROCESSOR_240 + SENSOR
    resting = PROCESSOR_80 + SENSOR_STANDBY
    if interval_ms == 0:
        return REGULATOR + working
    awake_s = AWAKE_FRAMES * FRAME_S
    # The two that fill the buffers are taken from the rest.
    period_s = interval_ms / 1000 + (AWAKE_FRAMES - 2) * FRAME_S
    share = min(1.0, awake_s / period_s)
    return REGULATOR + working * share + resting * (1 - share)


def watt_hours(current: Range) -> Range:
    """Energy of a day."""
    return current * (SUPPLY_V * 24 / 1000)


def table() -> str:
    """The table of docs/power.md."""
    leds = Range(LEDS_MA, LEDS_MA)
    dark = leds * (DARK_LIMIT / 255)
    rows = []
    for interval_ms in INTERVALS_MS:
        current = board(interval_ms)
        rows.append(
            f"| {interval_ms} | {current} | {current + leds} | {watt_hours(current + leds)} "
            f"| {current + dark} | {watt_hours(current + dark)} |"
        )
    return "\n".join(
        [
            "| `DECISION_MS` | board, mA | with LEDs, mA | Wh a day "
            f"| LEDs at `LED_LIMIT_DARK` {DARK_LIMIT}, mA | Wh a day |",
            "|---|---|---|---|---|---|",
            *rows,
            "",
        ]
    )


def main() -> int:
    """Write the table into the page and return the exit status."""
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN)
    PAGE.write_text(before + BEGIN + table() + END + rest.split(END)[1], encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
