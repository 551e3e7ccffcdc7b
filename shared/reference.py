"""The colour decision in plain Python, one pixel at a time: its definition.

Slow on purpose and free of tricks: exact divisions where the C multiplies by a
reciprocal, loops where numpy has arrays.  The golden vectors come from here;
the C and the numpy versions are held to them bit by bit.  It takes the numbers
of ``method.toml`` (``m``) and the generated tables (``t``) and needs nothing but
the standard library.

Equations are those of Knutson, Cao, Sattar (ICRA 2024); where this differs from
the printed text, ``docs/method.md`` says why.
"""

from __future__ import annotations

from typing import Any

Pixel = tuple[int, int, int]
Method = dict[str, Any]
Tables = dict[str, list[int]]

RGB565 = "rgb565"
RGB888 = "rgb888"


def pixel(frame: bytes, fmt: str, index: int) -> Pixel:
    """Channels as stored: 0..31, 0..63, 0..31 for big-endian RGB565, else 0..255."""
    if fmt == RGB565:
        word = frame[2 * index] << 8 | frame[2 * index + 1]
        return word >> 11, word >> 5 & 63, word & 31
    return frame[3 * index], frame[3 * index + 1], frame[3 * index + 2]


def box(index: int, size: int, cells: int) -> range:
    """Source pixels behind cell ``index``: equal shares, at least one pixel each."""
    first = index * size // cells
    return range(first, max(first + 1, (index + 1) * size // cells))


def working_image(m: Method, frame: bytes, fmt: str, width: int, height: int) -> list[Pixel]:
    """Box average to 80 x 60, 8 bits a channel, rounded once, halves up."""
    cells_x, cells_y = m["working_image"]["width"], m["working_image"]["height"]
    full = (31, 63, 31) if fmt == RGB565 else (255, 255, 255)
    image = []
    for cy in range(cells_y):
        for cx in range(cells_x):
            pixels = [
                pixel(frame, fmt, y * width + x)
                for y in box(cy, height, cells_y)
                for x in box(cx, width, cells_x)
            ]
            n = len(pixels)
            sums = [sum(p[c] for p in pixels) for c in range(3)]
            image.append(
                tuple((510 * sums[c] + full[c] * n) // (2 * full[c] * n) for c in range(3))
            )
    return image  # type: ignore[return-value]


def smooth(m: Method, image: list[Pixel]) -> list[Pixel]:
    """3 x 3 binomial, edge pixels repeated outwards, halves up."""
    w, h = m["working_image"]["width"], m["working_image"]["height"]

    def at(x: int, y: int, c: int) -> int:
        return image[min(max(y, 0), h - 1) * w + min(max(x, 0), w - 1)][c]

    def channel(x: int, y: int, c: int) -> int:
        total = 0
        for dy in (-1, 0, 1):
            for dx in (-1, 0, 1):
                total += (2 - abs(dx)) * (2 - abs(dy)) * at(x + dx, y + dy, c)
        return (total + 8) >> 4

    return [tuple(channel(x, y, c) for c in range(3)) for y in range(h) for x in range(w)]  # type: ignore[misc]


def grey(m: Method, p: Pixel) -> int:
    """OpenCV's integer luma, 0..255."""
    g = m["grey"]
    total = g["red"] * p[0] + g["green"] * p[1] + g["blue"] * p[2]
    return (total + (1 << g["shift"] - 1)) >> g["shift"]


def hsv(m: Method, t: Tables, p: Pixel) -> tuple[int, int, int, int]:
    """Hue 0..1535, saturation and value 0..255, chroma 0..255."""
    r, g, b = p
    value = max(p)
    chroma = value - min(p)
    shift, saturation_shift = m["hue"]["shift"], m["hue"]["opencv_shift"]
    if value == r:
        distance = g - b
    elif value == g:
        distance = b - r + 2 * chroma
    else:
        distance = r - g + 4 * chroma
    hue = (distance * t["HUE_DIVISION"][chroma] + (1 << shift - 1)) >> shift
    if hue < 0:
        hue += m["hue"]["range"]
    saturation = (
        chroma * t["SATURATION_DIVISION"][value] + (1 << saturation_shift - 1)
    ) >> saturation_shift
    return hue, saturation, value, chroma


def rgb_from_hsv(hue: int, saturation: int, value: int) -> Pixel:
    """The inverse on the hexcone; exact for every pure colour."""
    low = value - (value * saturation + 127) // 255
    chroma = value - low
    sextant, step = hue >> 8, hue & 255
    rising = low + ((chroma * step + 128) >> 8)
    falling = low + ((chroma * (256 - step) + 128) >> 8)
    return (
        (value, rising, low),
        (falling, value, low),
        (low, value, rising),
        (low, falling, value),
        (rising, low, value),
        (value, low, falling),
    )[sextant]


def cos_sin(m: Method, t: Tables, hue: int) -> tuple[int, int]:
    """Cosine and sine of a hue, in units of ``trig_unit``."""
    return t["SINE"][hue + m["hue"]["range"] // 4], t["SINE"][hue]


def hue_of_vector(m: Method, t: Tables, x: int, y: int) -> int | None:
    """Hue of a vector, None of the zero vector.  One division, one table."""
    turn = m["hue"]["range"]
    near, far = sorted((abs(x), abs(y)))
    if far == 0:
        return None
    while far >= 1 << 21:  # keeps near * atan_steps within 32 bits
        near, far = near >> 1, far >> 1
    hue = t["ARCTANGENT"][(near * m["hue"]["atan_steps"] + far // 2) // far]
    if abs(y) > abs(x):
        hue = turn // 4 - hue
    if x < 0:
        hue = turn // 2 - hue
    if y < 0:
        hue = turn - hue
    return hue % turn


def background(m: Method, t: Tables, image: list[Pixel], side: str = "dock") -> dict[str, Any]:
    """The fullest grey bin and the mean colour of its pixels.

    ``side``, ``dock`` or ``vehicle``, decides only below which value the water is taken for
    dark: what the vehicle's camera sees at night is the glow of the lamps that it looks at.
    """
    bins = m["background"]["bins"]
    bin_of = [grey(m, p) * bins >> 8 for p in image]
    counts = [bin_of.count(b) for b in range(bins)]
    fullest = counts.index(max(counts))  # the first of equals: ties go to the darker
    x = y = chroma_sum = saturation_sum = value_sum = 0
    for p, b in zip(image, bin_of, strict=True):
        if b == fullest:
            hue, saturation, value, chroma = hsv(m, t, p)
            cos, sin = cos_sin(m, t, hue)
            x += chroma * cos
            y += chroma * sin
            chroma_sum += chroma
            saturation_sum += saturation
            value_sum += value
    n = counts[fullest]
    mean_hue = hue_of_vector(m, t, x, y)
    saturation = (2 * saturation_sum + n) // (2 * n)
    value = (2 * value_sum + n) // (2 * n)
    resultant = 0
    if mean_hue is not None:
        cos, sin = cos_sin(m, t, mean_hue)
        length = (x * cos + y * sin) // m["hue"]["trig_unit"] ** 2
        resultant = min(255, (510 * length + chroma_sum) // (2 * chroma_sum))
    share = (510 * n + len(image)) // (2 * len(image))
    meaningful = (
        mean_hue is not None
        and saturation >= m["background"]["min_saturation"]
        and value >= m["background"]["min_value" if side == "dock" else "min_value_vehicle"]
        and resultant >= m["background"]["min_resultant"]
    )
    hue = mean_hue or 0
    return {
        "bin_counts": counts,
        "bin": fullest,
        "hue_x": x,
        "hue_y": y,
        "chroma_sum": chroma_sum,
        "saturation_sum": saturation_sum,
        "value_sum": value_sum,
        "hue": hue,
        "saturation": saturation,
        "value": value,
        "rgb": list(rgb_from_hsv(hue, saturation, value)),
        "resultant": resultant,
        "share": share,
        "confidence": (resultant * share + 127) // 255,
        "meaningful": meaningful,
    }


def marker_hue(m: Method, t: Tables, bkg: dict[str, Any], mapping: str, fallback_hue: int) -> int:
    """The mapping's hue for the background's, or the fallback; linear between nodes, halves up."""
    if not bkg["meaningful"]:
        return fallback_hue
    turn, nodes = m["hue"]["range"], m["marker"]["nodes"]
    step = turn // nodes
    node, beyond = divmod(bkg["hue"], step)
    at = m["marker"]["mappings"].index(mapping) * (nodes + 1) + node
    here, there = t["MARKER_HUE"][at], t["MARKER_HUE"][at + 1]
    hue = (2 * (here * (step - beyond) + there * beyond) + step) // (2 * step)
    return hue % turn


class RollingHue:
    """Circular mean of the decisions of the last ``window_ms``."""

    def __init__(self, m: Method, t: Tables, window_ms: int) -> None:
        self.m, self.t, self.window_ms = m, t, window_ms
        self.entries: list[tuple[int, int]] = []

    def add(self, hue: int, now_ms: int) -> int:
        """Take a decision at ``now_ms`` (32-bit clock) and return the mean hue."""
        capacity = rolling_capacity(self.m)
        self.entries.append((now_ms, hue))
        self.entries = [
            (t, h) for t, h in self.entries if (now_ms - t) & 0xFFFFFFFF < self.window_ms
        ][-capacity:]
        x = sum(cos_sin(self.m, self.t, h)[0] for _, h in self.entries)
        y = sum(cos_sin(self.m, self.t, h)[1] for _, h in self.entries)
        mean = hue_of_vector(self.m, self.t, x, y)
        return hue if mean is None else mean  # opposite hues cancel: the newest wins


class SteadyHue:
    """The hue shown: the rolling mean of decisions of one kind, of water with a hue or without.

    Near the limit between the kinds decisions of both come in turns, and the mean of a mapped hue
    and the fallback would be neither.  Decisions of the other kind are left out until none of the
    kind shown has come for ``hold_ms``; then the window is emptied and they are shown.
    """

    def __init__(self, m: Method, t: Tables, window_ms: int) -> None:
        self.m, self.t, self.window_ms = m, t, window_ms
        self.rolling = RollingHue(m, t, window_ms)
        self.meaningful: bool | None = None
        self.agreed_ms = self.shown = 0

    def add(self, meaningful: bool, hue: int, now_ms: int) -> int:
        """Take a decision at ``now_ms`` (32-bit clock) and return the hue to show."""
        if meaningful != self.meaningful:
            held_ms = (now_ms - self.agreed_ms) & 0xFFFFFFFF
            if self.meaningful is not None and held_ms < self.m["rolling"]["hold_ms"]:
                return self.shown
            self.rolling = RollingHue(self.m, self.t, self.window_ms)
        self.meaningful, self.agreed_ms = meaningful, now_ms
        self.shown = self.rolling.add(hue, now_ms)
        return self.shown


def rolling_capacity(m: Method) -> int:
    """Decisions that fit the longest window at the fastest rate."""
    r = m["rolling"]
    return r["max_window_ms"] * r["max_rate_hz"] // 1000


def dimmed_limit(limit: int, dark_limit: int, value: int) -> int:
    """Brightness limit for water of this HSV value, 0..255: ``dark_limit`` where it is black."""
    if dark_limit >= limit:
        return limit
    return dark_limit + ((limit - dark_limit) * value + 127) // 255


def led_duties(m: Method, t: Tables, hue: int, led: dict[str, Any]) -> list[int]:
    """PWM duties of a pure colour: offset, gamma, 3x3 matrix, limit, polarity."""
    unit, top = m["led"]["matrix_unit"], 1 << m["led"]["pwm_bits"]
    gamma = t["GAMMA"][256 * led["gamma"] : 256 * led["gamma"] + 256]
    code = [
        min(255, max(0, c + o))
        for c, o in zip(rgb_from_hsv(hue, 255, 255), led["offset"], strict=True)
    ]
    light = [gamma[c] for c in code]
    duties = []
    for row in range(3):
        mixed = sum(led["matrix"][3 * row + column] * light[column] for column in range(3))
        mixed = min(65535, max(0, (mixed + unit // 2) // unit))
        limited = (mixed * led["limit"] + 127) // 255
        duty = (limited * top + 32767) // 65535
        duties.append(top - duty if led["common_anode"] else duty)
    return duties
