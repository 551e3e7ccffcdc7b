"""The ``chromadock`` command.  Each subcommand has a file of its own beside this one.

These files import at their top only what the parser needs, and in the command itself what it
runs: so ``--help`` and a mistyped option answer at once.
"""

from __future__ import annotations

import io
import os
import signal
import sys
from types import FrameType
from typing import Annotated, NoReturn

import typer

from chromadock.cli.config import config
from chromadock.cli.demo import demo
from chromadock.cli.detect import detect
from chromadock.cli.dock import dock
from chromadock.cli.doctor import doctor
from chromadock.cli.evaluate import evaluate
from chromadock.cli.exit_status import (
    EXIT_BAD_INPUT,
    EXIT_BROKEN_PIPE,
    EXIT_INTERRUPTED,
    Terminated,
)
from chromadock.cli.replay import replay
from chromadock.cli.ros import RosCommand, ros
from chromadock.cli.run import run
from chromadock.cli.simulate import simulate
from chromadock.errors import ChromadockError
from chromadock.quiet import quiet_libraries
from chromadock.text import one_line

# Newer typers carry a copy of click, older ones import it: both raise this for a slip in
# the arguments.
_UsageError = typer.BadParameter.__mro__[2]

app = typer.Typer(
    help="Finds a docking station by the colour of its markers.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help: rich takes longer to load than all the rest
)
# More sources than one have a better line than the parser's.
app.command("detect", context_settings={"allow_extra_args": True})(detect)
app.command("demo")(demo)
app.command("doctor")(doctor)
app.command("evaluate")(evaluate)
app.command("replay")(replay)
app.command("ros", cls=RosCommand)(ros)
app.command("run")(run)
app.command("simulate")(simulate)
app.add_typer(config, name="config")
app.add_typer(dock, name="dock")


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib import metadata

        try:
            version = metadata.version("chromadock")
        except metadata.PackageNotFoundError:
            version = "(not installed)"
        print(f"chromadock {version}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """Finds a docking station by the colour of its markers."""


def main() -> NoReturn:
    """Run the command line; the only place that turns faults into a line and a status.

    Exit status: 0 all well, 1 some frames could not be read, 2 the input or the arguments
    are at fault, 130 Ctrl-C, 141 the reader of the output went away, 143 terminated (0 while a
    camera or a stream is watched, which has no other end).
    """
    signal.signal(signal.SIGTERM, _terminate)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a file's name may be any bytes
            stream.reconfigure(errors="backslashreplace")
    quiet_libraries()
    sys.exit(_run())


def _run() -> int:
    try:
        status = app(standalone_mode=False, prog_name="chromadock")
        sys.stdout.flush()
        return status if isinstance(status, int) else 0
    except ChromadockError as error:
        _complain(str(error))
        return EXIT_BAD_INPUT
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
    except typer.Abort:
        return EXIT_INTERRUPTED
    except BrokenPipeError:
        return _reader_gone()
    except SystemExit as error:
        if isinstance(error.__context__, BrokenPipeError):  # typer catches it first
            return _reader_gone()
        raise
    except Exception as error:
        if not isinstance(error, _UsageError):
            raise
        words = error.format_message() if hasattr(error, "format_message") else str(error)
        _complain(f"{one_line(words).rstrip('.')}: see chromadock --help")
        return EXIT_BAD_INPUT


def _reader_gone() -> int:
    # What is still buffered has no reader either; without this Python complains at exit.
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return EXIT_BROKEN_PIPE


def _complain(line: str) -> None:
    print(f"chromadock: error: {one_line(line, 500)}", file=sys.stderr)


def _terminate(_signal: int, _frame: FrameType | None) -> NoReturn:
    """Leave by way of the context managers, so that nothing half-written stays."""
    raise Terminated
