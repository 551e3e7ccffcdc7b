"""Small videos of every make, written by PyAV, for tests of what reads them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import av
import numpy as np

FPS = 20
PIXELS = {"mjpeg": "yuvj420p", "ffv1": "bgr0"}
"""What a codec stores, where that is not yuv420p."""
SIZE = (96, 64)
"""Width and height."""


def picture(number: int) -> np.ndarray:
    """HxWx3 uint8 BGR: noise that is hard to compress, and a grey that tells the number."""
    image = np.random.default_rng(number).integers(0, 40, (SIZE[1], SIZE[0], 3), dtype=np.uint8)
    image[16:48, 16:80] = level(number)
    return image


def level(number: int) -> int:
    """The grey value in the middle of a frame."""
    return 40 + 7 * number


def number_of(image: np.ndarray) -> int:
    """Which picture a decoded frame shows."""
    return round((float(image[24:40, 24:72].mean()) - 40) / 7)


def write_clip(
    path: Path,
    codec: str = "mjpeg",
    numbers: range | list[int] = range(30),
    sound_s: float = 0.0,
    options: dict[str, str] | None = None,
    muxer: dict[str, str] | None = None,
    shown: Callable[[int], np.ndarray] = picture,
    pixels: str | None = None,
    shift: int = 0,
) -> Path:
    """Write the numbered pictures, each at ``number / FPS`` seconds, and as much sound.

    With ``pixels`` of 16 bits the first channel alone, ``shift`` bits up.
    """
    with av.open(str(path), "w", options=muxer or {}) as container:
        stream = container.add_stream(codec, rate=FPS, options=options or {})
        stream.width, stream.height = SIZE
        stream.bit_rate = 8_000_000  # so that every grey is what was written
        stream.pix_fmt = pixels or PIXELS.get(codec, "yuv420p")
        sound = container.add_stream("pcm_s16le", rate=8000, layout="mono") if sound_s else None
        for number in numbers:
            image = shown(number)
            if pixels is not None:
                image = image[:, :, 0].astype(np.uint16) << shift
            frame = av.VideoFrame.from_ndarray(image, format=pixels or "bgr24")
            frame.pts = number
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
        if sound is not None:
            silence = np.zeros((1, round(8000 * sound_s)), np.int16)
            heard = av.AudioFrame.from_ndarray(silence, format="s16", layout="mono")
            heard.sample_rate, heard.pts = 8000, 0
            container.mux(sound.encode(heard))
            container.mux(sound.encode(None))
    return path


def packets(path: Path) -> list[tuple[int, int]]:
    """Where each compressed frame lies in the file, and its size in bytes."""
    with av.open(str(path)) as container:
        return [(p.pos, p.size) for p in container.demux(video=0) if p.size]


def overwrite(path: Path, number: int, share: float = 1.0) -> None:
    """Put zeros in the last ``share`` of one compressed frame."""
    position, size = packets(path)[number]
    data = bytearray(path.read_bytes())
    kept = round(size * (1 - share))
    data[position + kept : position + size] = bytes(size - kept)
    path.write_bytes(data)


def cut(path: Path, share: float) -> Path:
    """Keep the first ``share`` of the file."""
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    return path


def patch(path: Path, after: bytes, offset: int, new: bytes) -> Path:
    """Overwrite bytes, ``offset`` after the first place of ``after``."""
    data = bytearray(path.read_bytes())
    place = data.index(after) + len(after) + offset
    data[place : place + len(new)] = new
    path.write_bytes(data)
    return path
