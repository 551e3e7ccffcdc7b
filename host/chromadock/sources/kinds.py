"""Files that hold a picture, but not of a kind that can be read: told by their first bytes,
whatever their names are, and what to do with them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from PIL import Image

from chromadock.errors import ChromadockError

_HEIF = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1")
_RAW_HEADS = {
    b"FUJIFILMCCD-RAW": "RAF",
    b"FOVb": "X3F",
    b"IIRO": "ORF",
    b"IIRS": "ORF",
    b"MMOR": "ORF",
    b"IIU\0": "RW2",
    b"\0MRM": "MRW",
}
RAW_SUFFIXES = frozenset(
    (".dng", ".cr2", ".cr3", ".nef", ".nrw", ".arw", ".srw", ".pef", ".raf", ".orf", ".rw2", ".x3f")
)
"""Most raw files are TIFFs: these names, or tags inside, tell them from pictures."""

_DNG_VERSION, _SUB_IFDS, _SUBFILE, _PHOTOMETRIC = 50706, 330, 254, 262
_CFA, _LINEAR_RAW = 32803, 34892


def check_readable(path: Path) -> None:
    """Refuse what is a picture, but of a kind that cannot be read.

    Raises
    ------
    ChromadockError
        That names the kind and what to do.
    OSError
        Where the file cannot be read.
    """
    with path.open("rb") as file:
        head = file.read(32)
    brand = head[8:12] if head[4:8] == b"ftyp" else b""
    if brand in _HEIF:
        raise ChromadockError(
            f"{path}: a HEIC picture, whatever its name: convert it to JPEG or PNG, for instance "
            "with heif-convert, or set the phone to take JPEG"
        )
    if brand in (b"avif", b"avis") and ".avif" not in Image.registered_extensions():
        raise ChromadockError(f"{path}: an AVIF picture: convert it to JPEG or PNG")
    raw = _raw_kind(head, brand, path)
    if raw is not None:
        raise _raw(path, raw)


def check_tiff(path: Path, image: Image.Image) -> None:
    """Refuse a camera's raw file, of which Pillow would show the small preview.

    Raises
    ------
    ChromadockError
        That says what to do.
    """
    tags = tiff_tags(image)
    preview_of_more = tags.get(_SUBFILE) == 1 and _SUB_IFDS in tags
    if _DNG_VERSION in tags or preview_of_more or tags.get(_PHOTOMETRIC) in (_CFA, _LINEAR_RAW):
        raise _raw(path, "DNG" if _DNG_VERSION in tags else "TIFF")


def tiff_tags(image: Image.Image) -> Mapping[int, Any]:
    """The tags of a TIFF's page; none of other pictures."""
    tags: Mapping[int, Any] = getattr(image, "tag_v2", {})
    return tags


def _raw_kind(head: bytes, brand: bytes, path: Path) -> str | None:
    if brand == b"crx ":
        return "CR3"
    if head[:2] in (b"II", b"MM") and head[8:10] == b"CR":
        return "CR2"
    for start, kind in _RAW_HEADS.items():
        if head.startswith(start):
            return kind
    suffix = path.suffix.lower()
    if suffix in RAW_SUFFIXES and head[:4] in (b"II*\0", b"MM\0*"):
        return suffix[1:].upper()
    return None


def _raw(path: Path, kind: str) -> ChromadockError:
    return ChromadockError(
        f"{path}: a camera's raw file ({kind}): develop it to PNG, TIFF or JPEG first, for "
        "instance with dcraw or darktable"
    )
