"""The controls of a camera behind BlueOS's camera manager (mavlink-camera-manager), by its REST
interface.

``GET /v4l`` lists sources with their controls as they are, ``POST /v4l`` sets one, and
``GET /streams`` tells which source is behind a stream's address.
"""

from __future__ import annotations

import http.client
import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from pydantic import BaseModel, TypeAdapter, ValidationError

from chromadock.controls.base import Control, Controls, ControlsAwayError, RefusedError, Table
from chromadock.controls.features import NUMBERS
from chromadock.errors import ChromadockError
from chromadock.text import one_line

PORT = 6020
"""Of the manager, where nobody says another."""

_CONNECT_S = 2.0
_ANSWER_S = 10.0
"""It asks all its cameras for all that they can before it answers."""

_MOST_BYTES = 1 << 22
_RTSP_PORT = 554


class _Slider(BaseModel):
    value: int
    min: int
    max: int
    step: int


class _Option(BaseModel):
    value: int


class _Menu(BaseModel):
    value: int
    options: list[_Option]


class _Bool(BaseModel):
    value: int


class _Configuration(BaseModel):
    Slider: _Slider | None = None
    Menu: _Menu | None = None
    Bool: _Bool | None = None


class _State(BaseModel):
    is_disabled: bool = False


class _Control(BaseModel):
    id: int
    state: _State = _State()
    configuration: _Configuration

    def plain(self) -> Control | None:
        """As any other way to a camera gives it."""
        kind = self.configuration
        if self.state.is_disabled:
            return None
        if kind.Slider is not None:
            return Control(
                kind.Slider.value, kind.Slider.min, kind.Slider.max, max(kind.Slider.step, 1)
            )
        if kind.Bool is not None:
            return Control(kind.Bool.value, 0, 1, choices=frozenset((0, 1)))
        if kind.Menu is not None and kind.Menu.options:
            values = frozenset(option.value for option in kind.Menu.options)
            return Control(kind.Menu.value, min(values), max(values), choices=values)
        return None


class _Source(BaseModel):
    source: str
    controls: list[_Control] = []


_SOURCES = TypeAdapter(list[_Source])


@dataclass(frozen=True, slots=True)
class ManagerAddress:
    """Where a camera manager listens.

    ``path``: before its own, of a proxy in front of it; ``device``: the camera as the manager names
    it, empty where it is to be found out.
    """

    host: str
    port: int
    path: str = ""
    device: str = ""

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.port}{self.path}"


def manager_address(text: str) -> ManagerAddress:
    """``http://HOST[:PORT][/PATH][?device=/dev/video2]``.

    Raises
    ------
    ChromadockError
        Where it has another form.
    """
    try:
        parts = urlsplit(text)
        port = PORT if parts.port is None else parts.port
        query = dict(parse_qsl(parts.query, strict_parsing=True)) if parts.query else {}
    except ValueError:
        raise _no_address(text) from None
    well = parts.scheme == "http" and parts.hostname and parts.username is None
    if not well or parts.fragment or query.keys() - {"device"}:
        raise _no_address(text)
    return ManagerAddress(
        parts.hostname or "", port, parts.path.rstrip("/"), query.get("device", "")
    )


def _no_address(text: str) -> ChromadockError:
    return ChromadockError(
        f"camera.manager is {one_line(repr(text), 60)}: write http://HOST:{PORT}, and "
        "?device=/dev/video2 after it where it has several cameras"
    )


class CameraManager(Controls):
    """The controls of one of the manager's cameras.

    Parameters
    ----------
    address
        The manager's.
    stream
        Address of the stream that is watched, which tells the camera; empty where it is none of
        the manager's.
    """

    keeps = "the camera manager"

    def __init__(self, address: ManagerAddress, stream: str = "") -> None:
        self._address = address
        self._stream = stream
        self._device = address.device

    def read(self) -> Table:
        """See ``Controls``."""
        source = self._source()
        controls = {c.id: c.plain() for c in source.controls if c.id in NUMBERS}
        return {number: control for number, control in controls.items() if control is not None}

    def write(self, number: int, value: int) -> None:
        """See ``Controls``."""
        body = json.dumps({"device": self._device, "v4l_id": number, "value": value})
        status, said = self._ask("POST", "/v4l", body)
        if status == http.client.NOT_FOUND:
            raise self._away("answers, but not as a camera manager", "check camera.manager")
        if status >= http.client.BAD_REQUEST:
            raise RefusedError(one_line(said.decode(errors="replace"), 120) or f"status {status}")

    def _source(self) -> _Source:
        """The camera."""
        try:
            sources = _SOURCES.validate_json(self._get("/v4l"))
        except ValidationError:
            raise self._away(
                "answers, but not as a camera manager", "check camera.manager"
            ) from None
        self._device = self._device or self._behind_stream()
        if not self._device:
            able = [s.source for s in sources if s.controls]
            if len(able) != 1:
                raise self._away(
                    f"has {_list(able)}, and the stream is none of its own",
                    f"add ?device=NAME of a camera to camera.manager, as {self._address}?device="
                    f"{able[0] if able else '/dev/video0'}",
                )
            self._device = able[0]
        for source in sources:
            if source.source == self._device:
                return source
        raise self._away(
            f"has no camera {one_line(self._device, 60)}, but {_list([s.source for s in sources])}",
            "check its plug and the device in camera.manager",
        )

    def _behind_stream(self) -> str:
        """The device behind the stream that is watched; empty where nobody tells."""
        if not self._stream.lower().startswith("rtsp"):
            return ""
        try:
            streams = json.loads(self._get("/streams"))
            for each in streams:
                video = each["video_and_stream"]
                local = video["video_source"].get("Local")
                endpoints = video["stream_information"]["endpoints"]
                if local and any(_same_stream(end, self._stream) for end in endpoints):
                    return str(local["device_path"])
        except (ValueError, TypeError, KeyError, AttributeError):
            pass  # of another version: the only camera will be the one
        return ""

    def _get(self, path: str) -> bytes:
        status, content = self._ask("GET", path)
        if status != http.client.OK:
            raise self._away(
                f"answers {path} with status {status}", "check camera.manager and its log"
            )
        return content

    def _ask(self, method: str, path: str, body: str | None = None) -> tuple[int, bytes]:
        """One request: status and content of the answer."""
        line = http.client.HTTPConnection(
            self._address.host, self._address.port, timeout=_CONNECT_S
        )
        try:
            line.connect()
            line.sock.settimeout(_ANSWER_S)
            headers = {"Content-Type": "application/json"} if body else {}
            line.request(method, self._address.path + path, body, headers)
            answer = line.getresponse()
            return answer.status, answer.read(_MOST_BYTES)
        except (OSError, http.client.HTTPException, ValueError) as error:
            reason = one_line(getattr(error, "strerror", None) or error, 60) or "no answer"
            raise self._away(
                f"does not answer ({reason})",
                "check camera.manager, and that BlueOS's camera manager runs",
            ) from None
        finally:
            line.close()

    def _away(self, what: str, mend: str) -> ControlsAwayError:
        return ControlsAwayError(f"{self._address} {what}: {mend}")


def _list(sources: Sequence[str]) -> str:
    return ", ".join(one_line(s, 40) for s in sources[:8]) or "no camera with controls"


def _same_stream(one: Any, other: str) -> bool:
    """Whether two addresses are of one stream of one computer, which may have several names."""
    a, b = urlsplit(str(one)), urlsplit(other)
    return (
        a.scheme.startswith("rtsp")
        and b.scheme.startswith("rtsp")
        and (a.port or _RTSP_PORT) == (b.port or _RTSP_PORT)
        and a.path.rstrip("/") == b.path.rstrip("/")
    )
