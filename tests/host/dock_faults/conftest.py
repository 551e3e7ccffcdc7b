"""What goes wrong between a user and a dock: one line with the mend, within 3 s."""

import time

import pytest
from simulation import chromadock, running_dock

WITHIN_S = 3.0


@pytest.fixture
def refused(capsys):
    """Runs a command that must fail in one line that says all of ``says``.

    With ``soon`` it waits less for answers than a user would.
    """

    def run(*arguments, says, port=None, soon=False):
        arguments = [*arguments, *(["--timeout", 0.5] if soon else [])]
        start = time.monotonic()
        done = chromadock(capsys, "dock", *arguments, *(["--port", port] if port else []))
        assert time.monotonic() - start < WITHIN_S
        assert done.status == 2, done.out
        lines = done.err.splitlines()
        assert len(lines) == 1, done.err
        assert lines[0].startswith("chromadock: error: ")
        for words in [says] if isinstance(says, str) else says:
            assert words in lines[0], lines[0]
        return lines[0]

    return run


@pytest.fixture(scope="module")
def url():
    with running_dock() as (url, _dock):
        yield url
