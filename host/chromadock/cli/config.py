"""``chromadock config``: the vehicle's file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

config = typer.Typer(help="Write, check and show a vehicle's file.", no_args_is_help=True)

_File = Annotated[
    Path, typer.Argument(metavar="VEHICLE.toml", help="The vehicle's file.", show_default=False)
]


@config.command("init")
def init(path: _File) -> None:
    """Write a file with every key at its default, and what it means."""
    write_shipped_file(path)
    print(f"wrote {path}: set camera.source and camera.calibration first")


@config.command("check")
def check(path: _File) -> None:
    """Say what is wrong in the file, or in those that it names."""
    from chromadock.controls.opening import controls_of
    from chromadock.output.addresses import check_output
    from chromadock.vehicle.building import camera_of, detector_of, dock_of, outputs_of
    from chromadock.vehicle.reading import read_vehicle

    settings = read_vehicle(path)
    detector_of(settings, camera_of(settings), dock_of(settings))
    controls_of(settings.camera.source, settings.camera.manager)
    for text in outputs_of(settings):
        check_output(text)
    print(f"{path}: all keys are well")


@config.command("show")
def show(path: _File) -> None:
    """Print what holds: every key, those that are not at their default marked with *."""
    from chromadock.vehicle.manual import effective
    from chromadock.vehicle.reading import read_vehicle

    for key, value, changed in effective(read_vehicle(path)):
        print(f"{'*' if changed else ' '} {key} = {value}")


def write_shipped_file(path: Path) -> None:
    """Write the file with every key at its default, where there is none yet.

    Raises
    ------
    ChromadockError
        Where there is one, or none can be.
    """
    from chromadock.errors import ChromadockError
    from chromadock.output.base import cannot_write
    from chromadock.vehicle.manual import shipped_file

    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(shipped_file())
    except FileExistsError:
        raise ChromadockError(f"{path}: is there already: give another name") from None
    except OSError as error:
        raise cannot_write(path, error) from None
