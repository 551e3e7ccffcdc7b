"""A camera manager as BlueOS has it, of its REST interface what sets cameras: a real HTTP server on
loopback, that answers and refuses as mavlink-camera-manager does."""

from __future__ import annotations

import json
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

GAIN, WHITE_BALANCE_AUTO, WHITE_BALANCE = 0x00980913, 0x0098090C, 0x0098091A
EXPOSURE_AUTO, EXPOSURE = 0x009A0901, 0x009A0902
_MASTER = {WHITE_BALANCE: (WHITE_BALANCE_AUTO, 0), EXPOSURE: (EXPOSURE_AUTO, 1)}
"""What must have which value, or the control is inactive."""


def _control(number: int, kind: str, **configuration: Any) -> dict[str, Any]:
    return {
        "name": f"Control {number:x}", "cpp_type": "int64", "id": number,
        "state": {"is_disabled": False, "is_inactive": False},
        "configuration": {kind: configuration},
    }  # fmt: skip


def usual() -> list[dict[str, Any]]:
    """The controls of a UVC camera that has not been set."""
    modes = [{"name": "Manual Mode", "value": 1}, {"name": "Aperture Priority Mode", "value": 3}]
    return [
        _control(0x00980900, "Slider", default=0, value=0, step=1, max=64, min=-64),  # brightness
        _control(GAIN, "Slider", default=0, value=0, step=1, max=100, min=0),
        _control(WHITE_BALANCE_AUTO, "Bool", default=1, value=1),
        _control(WHITE_BALANCE, "Slider", default=4600, value=4600, step=1, max=6500, min=2800),
        _control(EXPOSURE_AUTO, "Menu", default=3, value=3, options=modes),
        _control(EXPOSURE, "Slider", default=156, value=156, step=1, max=5000, min=1),
    ]


class Manager:
    """The server; use it as a context manager.

    ``cameras``: controls by device; ``streams``: (endpoint, device); ``slow_s``: before each
    answer; ``status``: of all answers, but None for the usual; ``text``: sent instead of what was
    asked for; ``ignores``: numbers of controls that it takes and does not keep.
    """

    def __init__(self, *devices: str, port: int = 0) -> None:
        self.cameras = {device: usual() for device in devices}
        self.streams: list[tuple[str, str]] = []
        self.slow_s = 0.0
        self.status: int | None = None
        self.text: str | None = None
        self.ignores: set[int] = set()
        self.posts: list[dict[str, Any]] = []
        self._server = ThreadingHTTPServer(("127.0.0.1", port), _handler(self))
        self._server.daemon_threads = True
        self.port: int = self._server.server_address[1]
        self.url = f"http://127.0.0.1:{self.port}"

    def value(self, device: str, number: int) -> int:
        return int(next(iter(self.find(device, number)["configuration"].values()))["value"])

    def set(self, device: str, number: int, value: int) -> None:
        next(iter(self.find(device, number)["configuration"].values()))["value"] = value

    def find(self, device: str, number: int) -> dict[str, Any]:
        return next(c for c in self.cameras[device] if c["id"] == number)

    def listed(self) -> list[dict[str, Any]]:
        """What ``GET /v4l`` answers."""
        for device, controls in self.cameras.items():
            for control in controls:
                master, value = _MASTER.get(control["id"], (None, 0))
                if master is not None:
                    inactive = self.value(device, master) != value
                    control["state"]["is_inactive"] = inactive
        lists = [
            {"name": "H264 USB Camera", "source": d, "formats": [], "controls": c, "blocked": False}
            for d, c in self.cameras.items()
        ]
        return [*lists, {"name": "Fake", "source": "ball", "formats": [], "controls": []}]

    def playing(self) -> list[dict[str, Any]]:
        """What ``GET /streams`` answers."""
        return [
            {
                "id": "0", "running": True, "video_and_stream": {
                    "name": "stream",
                    "stream_information": {"endpoints": [endpoint]},
                    "video_source": {"Local": {"name": "H264", "device_path": device}},
                },
            }
            for endpoint, device in self.streams
        ]  # fmt: skip

    def post(self, asked: dict[str, Any]) -> str:
        """Set one control; why not, or nothing."""
        self.posts.append(asked)
        device, number, value = asked["device"], asked["v4l_id"], asked["value"]
        if device not in self.cameras:
            return f"The source string '{device}' does not exist"
        control = next((c for c in self.cameras[device] if c["id"] == number), None)
        if control is None:
            return f"Control ID {number} was not found"
        self.listed()
        kind, configuration = next(iter(control["configuration"].items()))
        if control["state"]["is_inactive"]:
            return f"Failed setting {number} to {value}: Control is inactive"
        well = {
            "Slider": lambda: configuration["min"] <= value <= configuration["max"],
            "Menu": lambda: value in [option["value"] for option in configuration["options"]],
            "Bool": lambda: value in (0, 1),
        }[kind]()
        if not well:
            return f"Failed setting {number} to {value}: Value is not one of the Control's"
        if number not in self.ignores:
            configuration["value"] = value
        return ""

    def __enter__(self) -> Manager:
        threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()


def _handler(manager: Manager) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            answers = {"/v4l": manager.listed, "/streams": manager.playing}
            if self.path in answers:
                self._answer(200, json.dumps(answers[self.path]()))
            else:
                self._answer(200, "<!DOCTYPE html>")  # of its own page, for any other path

        def do_POST(self) -> None:
            asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            if self.path != "/v4l" or self.headers["Content-Type"] != "application/json":
                self._answer(404, "")
                return
            fault = manager.post(asked)
            self._answer(500 if fault else 200, f"Internal Server Error: {fault}" if fault else "")

        def _answer(self, status: int, text: str) -> None:
            time.sleep(manager.slow_s)
            content = (text if manager.text is None else manager.text).encode()
            self.send_response(status if manager.status is None else manager.status)
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, *_: object) -> None:
            """Nothing is printed."""

    return Handler
