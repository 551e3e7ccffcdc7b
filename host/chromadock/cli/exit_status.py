"""What the command line returns to the shell."""

from __future__ import annotations

import signal

EXIT_SKIPPED = 1
"""Some frames could not be read; the others were used."""
EXIT_FAULTS = 1
"""What was looked at has a fault."""
EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 128 + signal.SIGINT
EXIT_TERMINATED = 128 + signal.SIGTERM
EXIT_BROKEN_PIPE = 128 + signal.SIGPIPE


class Terminated(SystemExit):
    """Raised where the program is when somebody terminates it."""

    def __init__(self) -> None:
        super().__init__(EXIT_TERMINATED)
