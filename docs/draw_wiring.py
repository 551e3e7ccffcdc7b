"""Draws docs/images/wiring-direct.svg and wiring-mosfet.svg: `python3 docs/draw_wiring.py`.

Coordinates are SVG user units, x right, y down.  Wires are drawn in order; a later one that
crosses an earlier one leaves a gap in it, and only a dot joins wires.
"""

from __future__ import annotations

from html import escape
from pathlib import Path

IMAGES = Path(__file__).resolve().parent / "images"

INK = "#22272e"
FAINT = "#8a929c"
RED, GREEN, BLUE = "#c62828", "#2e7d32", "#1565c0"
SUPPLY, REGULATED = "#d9730d", "#8e44ad"
COLOUR = {"R": RED, "G": GREEN, "B": BLUE}

LEFT_HEADER = ("3V3", "IO16", "IO0", "GND", "VCC", "U0R", "U0T", "GND/R")
RIGHT_HEADER = ("5V", "GND", "IO12", "IO13", "IO15", "IO14", "IO2", "IO4")
CHANNEL_OF = {"IO13": "R", "IO15": "B", "IO14": "G"}
LED_NAMES = ("top left", "top right", "bottom left", "bottom right")
PITCH = 36
LED_PITCH = 200


class Drawing:
    """Shapes of one picture, in the order in which they are painted."""

    def __init__(self, width: int, height: int, title: str, description: str) -> None:
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'width="{width}" height="{height}" role="img" '
            'font-family="DejaVu Sans, Verdana, Helvetica, Arial, sans-serif">',
            f"<title>{escape(title)}</title>",
            f"<desc>{escape(description)}</desc>",
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
        ]
        self.text(40, 44, title, size=24, weight="bold")

    def text(
        self,
        x: float,
        y: float,
        words: str,
        *,
        size: int = 16,
        colour: str = INK,
        anchor: str = "start",
        weight: str = "normal",
    ) -> None:
        """Writes a line of text; y is its baseline."""
        self.parts.append(
            f'<text x="{x:g}" y="{y:g}" font-size="{size}" fill="{colour}" '
            f'text-anchor="{anchor}" font-weight="{weight}">{escape(words)}</text>'
        )

    def path(self, d: str, colour: str = INK, width: float = 2.5, fill: str = "none") -> None:
        """Draws an SVG path."""
        self.parts.append(
            f'<path d="{d}" stroke="{colour}" stroke-width="{width:g}" fill="{fill}" '
            'stroke-linecap="round" stroke-linejoin="round"/>'
        )

    def wire(self, colour: str, *points: tuple[float, float]) -> None:
        """Joins the points, over whatever lies below."""
        d = "M" + " L".join(f"{x:g} {y:g}" for x, y in points)
        self.parts.append(
            f'<path d="{d}" stroke="#ffffff" stroke-width="9" fill="none" stroke-linecap="butt"/>'
        )
        self.path(d, colour, 3)

    def dot(self, x: float, y: float, colour: str = INK) -> None:
        """Marks a joint of wires."""
        self.parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="5" fill="{colour}"/>')

    def box(self, x: float, y: float, width: float, height: float, fill: str = "#f6f8fa") -> None:
        """Draws the outline of a part."""
        self.parts.append(
            f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="10" '
            f'fill="{fill}" stroke="{INK}" stroke-width="2"/>'
        )

    def upright_resistor(self, x: float, y: float, colour: str = INK) -> None:
        """Draws a resistor from y to y + 46."""
        self.parts.append(
            f'<rect x="{x - 8:g}" y="{y:g}" width="16" height="46" rx="2" '
            f'fill="#ffffff" stroke="{colour}" stroke-width="2.5"/>'
        )

    def lying_resistor(self, x: float, y: float, colour: str = INK) -> None:
        """Draws a resistor from x to x + 46."""
        self.parts.append(
            f'<rect x="{x:g}" y="{y - 8:g}" width="46" height="16" rx="2" '
            f'fill="#ffffff" stroke="{colour}" stroke-width="2.5"/>'
        )

    def ground(self, x: float, y: float) -> None:
        """Draws the ground symbol hanging from (x, y)."""
        self.path(
            f"M{x:g} {y:g} v10 M{x - 16:g} {y + 10:g} h32 M{x - 10:g} {y + 16:g} h20 "
            f"M{x - 4:g} {y + 22:g} h8"
        )

    def diode(self, x: float, y: float, colour: str) -> None:
        """Draws an LED, anode at (x, y), cathode at (x, y + 28), light to the right."""
        self.path(f"M{x - 11:g} {y + 4:g} h22 l-11 20 z", colour, 2, fill=colour)
        self.path(f"M{x - 11:g} {y + 24:g} h22", colour, 3)
        for shift in (0, 8):
            self.path(f"M{x + 12:g} {y + 10 + shift:g} l8 -5 m-5 -1 l5 1 l-2 5", colour, 1.5)

    def save(self, path: Path) -> None:
        """Writes the picture."""
        path.write_text("\n".join([*self.parts, "</svg>", ""]), encoding="utf-8")


def draw_board(
    drawing: Drawing, x: float, y: float, used_pins: set[str]
) -> dict[str, tuple[float, float]]:
    """Draws the board, top left corner at (x, y), and returns its pins' places."""
    width, height = 240, PITCH * 8 + 96
    drawing.box(x, y, width, height, "#eef2f6")
    centre = x + width / 2
    drawing.text(centre, y + 28, "AI-Thinker ESP32-CAM", size=17, anchor="middle", weight="bold")
    drawing.text(centre, y + 50, "SD slot empty", size=14, anchor="middle", colour=FAINT)
    pins = {}
    for i, (left, right) in enumerate(zip(LEFT_HEADER, RIGHT_HEADER, strict=True)):
        level = y + 84 + PITCH * i
        for name, pin_x, text_x, anchor in (
            (left, x, x + 16, "start"),
            (right, x + width, x + width - 16, "end"),
        ):
            key = name if pin_x > x or name != "GND" else "GND left"
            pins[key] = (pin_x, level)
            used = name in used_pins
            channel = CHANNEL_OF.get(name)
            colour = COLOUR[channel] if channel else INK if used else FAINT
            drawing.parts.append(
                f'<circle cx="{pin_x:g}" cy="{level:g}" r="6" fill="#ffffff" '
                f'stroke="{colour}" stroke-width="2.5"/>'
            )
            label = f"{name}  {channel}" if channel else name
            drawing.text(
                text_x,
                level + 6,
                label,
                colour=colour,
                anchor=anchor,
                weight="bold" if used else "normal",
            )
    drawing.text(
        centre,
        y + height + 24,
        "grey pins: connect nothing",
        size=14,
        anchor="middle",
        colour=FAINT,
    )
    return pins


def draw_leds(
    drawing: Drawing,
    x: float,
    rail: float,
    rail_colour: str,
    bus: dict[str, float],
    ohms: dict[str, str],
) -> None:
    """Draws four common-anode LEDs between the anode rail and the three cathode wires."""
    top = rail + 46
    for i, name in enumerate(LED_NAMES):
        left = x + LED_PITCH * i
        anode = left + 90
        drawing.box(left, top, 180, 112)
        drawing.text(anode, top + 24, f"LED {name}", size=15, anchor="middle")
        drawing.wire(rail_colour, (anode, rail), (anode, top - 1))
        drawing.dot(anode, rail, rail_colour)
        drawing.text(anode + 10, top - 12, "anode", size=13, colour=FAINT)
        inner = top + 44
        drawing.path(f"M{anode:g} {top + 32:g} V{inner:g} M{left + 30:g} {inner:g} h116", INK, 2)
        for j, channel in enumerate("RGB"):
            at, colour = left + 30 + 58 * j, COLOUR[channel]
            drawing.path(f"M{at:g} {inner:g} v12", INK, 2)
            drawing.diode(at, inner + 10, colour)
            drawing.path(f"M{at:g} {inner + 34:g} V{top + 112:g}", colour, 3)
            resistor = top + 132
            drawing.wire(colour, (at, top + 113), (at, bus[channel]))
            drawing.upright_resistor(at, resistor, colour)
            drawing.text(at + 13, resistor + 28, ohms[channel], size=14)
            drawing.dot(at, bus[channel], colour)


def last_joint(x: float) -> dict[str, float]:
    """Where the wires of the LEDs that start at x end: anode rail "A", cathodes R, G, B."""
    left = x + LED_PITCH * 3
    return {"A": left + 90, "R": left + 30, "G": left + 88, "B": left + 146}


def draw_adapter(drawing: Drawing, pins: dict[str, tuple[float, float]], y: float) -> None:
    """Draws the serial adapter under the board and its three wires."""
    edge = pins["U0R"][0]
    drawing.box(edge - 140, y, 330, 62)
    for (pin, label), shift in zip(
        (("GND left", "GND"), ("U0R", "TXD"), ("U0T", "RXD")), (110, 70, 30), strict=True
    ):
        px, py = pins[pin]
        drawing.wire(INK, (px - 6, py), (edge - shift, py), (edge - shift, y))
        drawing.text(edge - shift, y + 24, label, size=14, anchor="middle")
    drawing.text(edge + 16, y + 27, "USB-serial adapter", size=15, weight="bold")
    drawing.text(edge + 16, y + 48, "3.3 V logic; optional", size=14, colour=FAINT)


def draw_supply(
    drawing: Drawing, pins: dict[str, tuple[float, float]], x: float, y: float
) -> tuple[float, float]:
    """Draws the 5 V supply with its capacitor, wired to the board; returns its +5 V joint."""
    drawing.box(x, y, 150, 88)
    drawing.text(x + 16, y + 36, "5 V supply", size=17, weight="bold")
    drawing.text(x + 16, y + 62, "fused, 1 A", size=14, colour=FAINT)
    drawing.text(x + 138, y + 24, "+", size=20, anchor="end", weight="bold")
    drawing.text(x + 138, y + 76, "\N{MINUS SIGN}", size=20, anchor="end", weight="bold")
    plus, minus = y + 18, y + 70
    right = pins["5V"][0]
    five, ground = right + 26, right + 58
    capacitor = x + 190
    level = pins["GND"][1]
    drawing.wire(INK, (x + 151, minus), (ground, minus), (ground, level), (right + 6, level))
    level = pins["5V"][1]
    drawing.wire(SUPPLY, (x + 151, plus), (five, plus), (five, level), (right + 6, level))
    middle = (plus + minus) / 2
    drawing.path(f"M{capacitor} {plus} V{middle - 5} m-14 0 h28", INK)
    drawing.path(f"M{capacitor} {minus} V{middle + 5} m-14 0 h28", INK)
    drawing.dot(capacitor, plus, SUPPLY)
    drawing.dot(capacitor, minus)
    drawing.text(capacitor + 20, middle + 6, "470 µF", size=14)
    drawing.dot(ground, pins["GND"][1])
    drawing.path(f"M{ground} {pins['GND'][1]} v14", INK, 3)
    drawing.ground(ground, pins["GND"][1] + 10)
    return five, plus


def draw_notes(drawing: Drawing, x: float, y: float, lines: tuple[str, ...]) -> None:
    """Writes what must be known beside the wires; the first line stands out."""
    for i, line in enumerate(lines):
        drawing.text(x, y + 28 * i, line, weight="normal" if i else "bold")


def draw_direct() -> Drawing:
    """The LEDs on the pins, for the bench."""
    drawing = Drawing(
        1400,
        760,
        "Direct: common-anode LEDs on the pins (bench, a few mA)",
        "3V3 to the four common anodes; each cathode through its own resistor to GPIO 13 (red), "
        "15 (blue), 14 (green).  The pin pulls the cathode low to light the LED.",
    )
    pins = draw_board(drawing, 170, 250, {"3V3", "5V", "GND", "U0R", "U0T", *CHANNEL_OF})
    draw_supply(drawing, pins, 170, 130)
    draw_adapter(drawing, pins, 686)
    rail, leds = 90, 550
    end = last_joint(leds)
    px, py = pins["3V3"]
    drawing.wire(REGULATED, (px - 6, py), (px - 60, py), (px - 60, rail), (end["A"], rail))
    drawing.text(
        px - 60, rail - 12, "3V3 to the anodes, never 5 V", colour=REGULATED, weight="bold"
    )
    bus = {channel: pins[pin][1] for pin, channel in CHANNEL_OF.items()}
    for channel, y in bus.items():
        drawing.wire(COLOUR[channel], (pins["5V"][0] + 6, y), (end[channel], y))
    draw_leds(drawing, leds, rail, REGULATED, bus, {"R": "1k", "G": "470", "B": "470"})
    draw_notes(
        drawing,
        550,
        590,
        (
            "Pin low: lit.  Pin high, 3.3 V: dark.  LED_ANODE = 1, to be saved.",
            "A resistor for each of the 12 cathodes, in ohms: about 1.5 mA a die, 6 mA a pin.",
            "A dot joins wires; a gap is a crossing.  GND: any of the board's, not GND/R.",
            "On the ESP32-CAM-MB its USB plug is supply and serial adapter: leave both off.",
        ),
    )
    return drawing


def draw_mosfet() -> Drawing:
    """The LEDs through transistors, for the dock."""
    drawing = Drawing(
        1550,
        940,
        "MOSFET: common-anode LEDs on 5 V through low-side transistors (LED_ANODE = 0)",
        "+5 V to the four common anodes; each cathode through its own resistor to the drain of its "
        "channel's N-MOSFET; source to ground; gate through 100 ohm from GPIO 13 (red), 15 (blue), "
        "14 (green), 4.7 kilohm from gate to ground.",
    )
    pins = draw_board(drawing, 170, 400, {"5V", "GND", "U0R", "U0T", *CHANNEL_OF})
    five, plus = draw_supply(drawing, pins, 170, 200)
    draw_adapter(drawing, pins, 840)
    rail, leds = 90, 750
    end = last_joint(leds)
    drawing.wire(SUPPLY, (five, plus), (five, rail), (end["A"], rail))
    drawing.dot(five, plus, SUPPLY)
    drawing.text(five, rail - 12, "+5 V to the anodes", colour=SUPPLY, weight="bold")
    bus = {"R": 346, "B": 382, "G": 418}
    place = {"R": (640, 512), "B": (675, 642), "G": (710, 772)}
    for pin, channel in CHANNEL_OF.items():
        colour = COLOUR[channel]
        x, y = place[channel]
        px, py = pins[pin]
        drawing.wire(colour, (px + 6, py), (505, py), (505, y), (x - 20, y))
        draw_transistor(drawing, x, y, colour)
        drawing.wire(colour, (x + 12, y - 24), (x + 12, bus[channel]), (end[channel], bus[channel]))
    draw_leds(drawing, leds, rail, SUPPLY, bus, {"R": "150", "G": "100", "B": "100"})
    draw_notes(
        drawing,
        800,
        560,
        (
            "LED_ANODE = 0, the default: see that it is before the anodes get +5 V.",
            "Pin high: lit.  Pin low: dark.  With LED_ANODE = 1 all is reversed.",
            "A resistor for each of the 12 cathodes, in ohms: 18 to 20 mA a die.",
            "Gate: 100 ohms in series, 4.7k to ground.  Source to ground.",
            "MOSFET: N-channel, on-resistance specified at a gate of 2.5 V.",
            "Ground symbols are one wire: supply, board, transistors, adapter.",
            "A dot joins wires; a gap is a crossing.  Leave GND/R alone.",
        ),
    )
    return drawing


def draw_transistor(drawing: Drawing, x: float, y: float, colour: str) -> None:
    """Draws an N-MOSFET, drain at (x + 12, y - 24), with its gate parts to the left."""
    drawing.lying_resistor(x - 110, y, colour)
    drawing.text(x - 87, y - 14, "100 Ω", size=14, anchor="middle")
    node, floor = x - 40, y + 76
    drawing.path(f"M{node} {y} V{floor} H{x + 12}", INK, 2.5)
    drawing.dot(node, y, colour)
    drawing.upright_resistor(node, y + 16)
    drawing.text(node - 14, y + 45, "4.7 kΩ", size=14, anchor="end")
    drawing.path(f"M{x - 20} {y} H{x - 10} M{x - 10} {y - 18} v36", INK, 2.5)
    drawing.path(f"M{x - 3} {y - 22} v12 M{x - 3} {y - 6} v12 M{x - 3} {y + 10} v12", INK, 3)
    drawing.path(f"M{x - 3} {y - 16} H{x + 12} V{y - 24}", INK, 2.5)
    drawing.path(f"M{x - 3} {y} H{x + 12} V{floor} M{x - 3} {y + 16} H{x + 12}", INK, 2.5)
    drawing.path(f"M{x - 2} {y} l9 -5 v10 z", INK, 1, fill=INK)
    drawing.dot(x + 12, floor)
    drawing.ground(x + 12, floor)
    drawing.text(x + 22, y - 12, "D", size=13, colour=FAINT)
    drawing.text(x + 22, y + 24, "S", size=13, colour=FAINT)


def main() -> None:
    """Writes both pictures."""
    IMAGES.mkdir(exist_ok=True)
    draw_direct().save(IMAGES / "wiring-direct.svg")
    draw_mosfet().save(IMAGES / "wiring-mosfet.svg")


if __name__ == "__main__":
    main()
