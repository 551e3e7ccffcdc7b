"""``chromadock dock simulate``: a dock without a board."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Annotated

import typer

from chromadock.errors import ChromadockError

_MOST_FPS = 60.0
_MOST_SAVE_S = 60.0


def simulate(
    source: Annotated[
        str | None,
        typer.Argument(
            metavar="SOURCE",
            help="What its camera sees: a picture, folder, video, camera index, or URL.",
            show_default="plain blue water",
        ),
    ] = None,
    tcp: Annotated[
        str | None,
        typer.Option(
            metavar="HOST:PORT",
            help="Listen there, on this computer only; port 0: any that is free.",
            show_default="a pseudo-terminal",
        ),
    ] = None,
    fps: Annotated[float, typer.Option(help="Frames a second.")] = 10.0,
    settings: Annotated[
        Path | None,
        typer.Option(help="File for the saved parameters.", show_default="memory"),
    ] = None,
    fault: Annotated[
        list[str] | None,
        typer.Option(
            help="What goes wrong, e.g. camera-timeout@10s; may be repeated. Of: camera-timeout, "
            "camera-lost, noise, boot-text, driver-text, reboot, storage, corrupt=0.01.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of noise and corruption.")] = 0,
    own_light: Annotated[
        float,
        typer.Option(help="What its camera sees of its lamps, share 0 .. 1 of full scale."),
    ] = 0.0,
    save_time: Annotated[
        float, typer.Option(help="Seconds that saving the parameters takes; a board: 0.24 .. 4.")
    ] = 0.5,
) -> None:
    """Run the dock's own firmware core in this process, behind a serial port.

    The first line tells its port, for --port of the other commands.  The core,
    its link and its parameters are the board's own code.

    Not imitated: the sensor (settling, noise, what exposure, gain and white
    balance do to a frame), the processor's speed, the
    watchdog, brown-outs, flash wear, baud rates other than the default, DTR and
    RTS, which do not reset it.
    """
    from chromadock.simulated import PtyPort, SimulatedDock, TcpPort, parse_fault, serve
    from chromadock.simulated.camera import open_camera
    from chromadock.simulated.loop import CLOCK

    if not 0 < fps <= _MOST_FPS:
        raise ChromadockError(f"--fps is {fps:g}: give frames a second, above 0 .. {_MOST_FPS:g}")
    if not 0 <= own_light <= 1:
        raise ChromadockError(f"--own-light is {own_light:g}: give a share, 0 .. 1, such as 0.01")
    if not 0 <= save_time <= _MOST_SAVE_S:
        raise ChromadockError(f"--save-time is {save_time:g}: give seconds, 0 .. {_MOST_SAVE_S:g}")
    faults = [parse_fault(text) for text in fault or []]
    camera = open_camera(source)
    port = None
    try:
        dock = SimulatedDock(
            camera, fps, settings, faults, seed, CLOCK(), own_light=own_light, save_s=save_time
        )
        port = PtyPort() if tcp is None else TcpPort(tcp)
        print(f"port: {port.url}", flush=True)
        serve(dock, port, Event())
    finally:
        if port is not None:
            port.close()
        camera.close()
