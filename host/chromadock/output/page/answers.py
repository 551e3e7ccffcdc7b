"""From a path that a client asks for to the answer."""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from chromadock.output.page.blueos import service
from chromadock.output.page.picture import Picture
from chromadock.output.page.recordings import recordings
from chromadock.output.page.status import Status

JSON, HTML, TEXT = "application/json", "text/html; charset=utf-8", "text/plain; charset=utf-8"


@dataclass(frozen=True, slots=True)
class Answer:
    """An HTTP status, the content's type, and the content, or the file that has it."""

    status: int
    kind: str
    content: bytes | Path


def answer(path: str, status: Status, picture: Picture, now_s: float) -> Answer:
    """What a client gets that asks for ``path``; nothing else can be asked for.

    ``/`` the page; ``/status.json``; ``/picture.jpg``; ``/vehicle.toml``, the settings as they
    hold; ``/recordings/NAME``; ``/healthz`` 200 while results come, else 503 with the reason;
    ``/register_service`` for BlueOS.
    """
    place = unquote(path.partition("?")[0])
    if place == "/":
        return Answer(
            200, HTML, (resources.files("chromadock.output.page") / "index.html").read_bytes()
        )
    if place == "/status.json":
        found = {**status.record(now_s), "recordings": _recordings(status)}
        return Answer(200, JSON, _json(found))
    if place == "/register_service":
        return Answer(200, JSON, _json(service()))
    if place == "/healthz":
        trouble = status.trouble(now_s)
        return _text(200, "ok") if trouble is None else _text(503, trouble)
    if place == "/vehicle.toml":
        return _text(200, status.record(now_s)["vehicle"])
    if place == "/picture.jpg" and status.newest is not None:
        return Answer(200, "image/jpeg", picture.jpeg(status.newest, status.setup))
    folder, _, name = place.rpartition("/")
    file = recordings(status.setup).get(name) if folder == "/recordings" else None
    return _text(404, "nothing here") if file is None else Answer(200, "application/x-mcap", file)


def _recordings(status: Status) -> list[dict[str, Any]]:
    files = recordings(status.setup).items()
    return [{"name": name, "bytes": path.stat().st_size} for name, path in files]


def _json(value: Any) -> bytes:
    return json.dumps(value).encode()


def _text(status: int, words: str) -> Answer:
    return Answer(status, TEXT, f"{words}\n".encode())
