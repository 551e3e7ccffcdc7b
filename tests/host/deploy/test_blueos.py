"""The BlueOS extension: its labels as BlueOS reads them, its commands, its pages over HTTP.

No Docker runs here: its commands do, in a folder in place of ``/data``.  ``make image`` builds
what the image holds.
"""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path
from typing import Any
from urllib.error import HTTPError

from autopilot_peer import free_port
from dockerfile import copied, exec_form, instructions, labels, runs
from patience import until
from web_camera import web_camera

from chromadock.output.page.blueos import service

ROOT = Path(__file__).resolve().parents[3]
DOCKERFILE = ROOT / "deploy" / "blueos" / "Dockerfile"
PORT = 8642
OF_BLUEOS = {
    *(22, 80, 81, 2748, 2770, 5555, 5777, 6020, 6021, 6030, 6040, 7777, 8000, 8081, 8088, 8554),
    *(9000, 9002, 9090, 9100, 9101, 9110, 9111, 9120, 9134, 27353),
}
"""Ports that its own services have, by its ``core/services/helper/main.py``."""


def test_the_labels_are_what_the_extensions_repository_reads() -> None:
    """By its README and ``blueos_repository/extension/extension.py``."""
    told = labels(DOCKERFILE)
    assert told["version"] == metadata.version("chromadock")
    assert re.fullmatch(r"\d+\.\d+\.\d+", told["version"])
    assert told["type"] in {"device-integration", "example", "tool", "other"}
    tags = json.loads(told["tags"])
    assert 0 < len(tags) <= 10 and all(re.fullmatch(r"[a-z0-9-]+", tag) for tag in tags)
    assert {"name", "email"} <= set(json.loads(told["authors"])[0])
    assert {"name", "email", "about"} <= set(json.loads(told["company"]))
    assert isinstance(json.loads(told["links"]), dict) and "readme" in told
    assert re.fullmatch(r"core >= \d+\.\d+", told["requirements"])


def test_the_permissions_are_a_payload_of_dockers_for_the_commands_of_the_image() -> None:
    host = json.loads(labels(DOCKERFILE)["permissions"])["HostConfig"]
    assert host["NetworkMode"] == "host" and "Privileged" not in host
    binds = dict(bind.split(":")[::-1] for bind in host["Binds"])
    assert binds["/dev"] == "/dev"
    assert binds[dict(instructions(DOCKERFILE))["WORKDIR"]] == "/usr/blueos/extensions/chromadock"
    assert all(re.fullmatch(r"c \d+:\* rmw", rule) for rule in host["DeviceCgroupRules"])


def test_the_port_is_one_and_none_of_blueos_own() -> None:
    text = DOCKERFILE.read_text()
    assert set(map(int, re.findall(r"(?:0\.0\.0\.0|127\.0\.0\.1):(\d+)", text))) == {PORT}
    assert dict(instructions(DOCKERFILE))["EXPOSE"] == f"{PORT}/tcp"
    assert PORT not in OF_BLUEOS


def test_all_that_is_copied_is_there_and_let_into_the_context() -> None:
    ignore = DOCKERFILE.with_name("Dockerfile.dockerignore").read_text().splitlines()
    assert "*" in ignore
    for source in copied(DOCKERFILE):
        assert (ROOT / source).exists(), source
        assert f"!{source}" in ignore


def test_the_last_stage_compiles_nothing() -> None:
    build, last = runs(DOCKERFILE)
    assert any("gcc" in command for command in build)
    assert not any("apt-get" in command for command in last)
    assert all("--only-binary=:all:" in command for command in last if "pip install" in command)


def command(name: str, port: int) -> list[str]:
    """A command of the image, at a port that is free here."""
    return [argument.replace(str(PORT), str(port)) for argument in exec_form(DOCKERFILE, name)]


def ask(port: int, path: str) -> Any:
    """The answer's text, or its status where that is no 200."""
    try:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=5) as answer:
            return answer.read().decode()
    except HTTPError as error:
        return error.code
    except OSError:
        return None


def healthy(port: int) -> bool:
    """As Docker asks, by the image's own command."""
    python, *arguments = command("HEALTHCHECK", port)
    assert python == "python"
    done = subprocess.run([sys.executable, *arguments], capture_output=True)
    return done.returncode == 0


@contextmanager
def extension(data: Path, port: int) -> Iterator[subprocess.Popen[bytes]]:
    """The image's command, with ``data`` in place of ``/data``."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    with subprocess.Popen(command("CMD", port), cwd=data, env={**os.environ, "PATH": path}) as run:
        try:
            yield run
        finally:
            run.kill()


def test_the_extension_answers_blueos_from_its_first_start_to_a_tracked_dock(
    tmp_path: Path,
) -> None:
    """First without a file: it must not die, or BlueOS would start it again and again."""
    port = free_port(socket.SOCK_STREAM)
    with web_camera() as camera, extension(tmp_path, port) as run:
        until(lambda: ask(port, "/status.json"))
        until(lambda: json.loads(ask(port, "/status.json"))["trouble"] != "no picture yet")
        assert json.loads(ask(port, "/register_service")) == service()
        assert "<title>Chromadock</title>" in ask(port, "/")
        vehicle = tmp_path / "vehicle.toml"
        assert "[camera]" in vehicle.read_text()
        if not Path("/dev/video0").exists():
            assert ask(port, "/healthz") == 503 and not healthy(port)
            assert "camera 0" in json.loads(ask(port, "/status.json"))["trouble"]
        text = vehicle.read_text().replace('source = "0"', f'source = "{camera}"')
        vehicle.write_text(text.replace('record = ""', 'record = "dive.mcap"'))
        until(lambda: '"state": "tracking"' in str(ask(port, "/status.json")))
        told = json.loads(ask(port, "/status.json"))
        assert told["trouble"] is None and told["recordings"][0]["name"] == "dive.mcap"
        assert healthy(port)
        run.send_signal(signal.SIGTERM)
        assert run.wait(10) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"vehicle.toml", "dive.mcap"}
