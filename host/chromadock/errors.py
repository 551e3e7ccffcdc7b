"""The one exception a user's mistake can raise."""

from __future__ import annotations


class ChromadockError(Exception):
    """A fault in what the user gave: one line that says what, where and the mend.

    The command line prints it after ``chromadock: error:`` and exits with 2; it
    never shows a traceback for it.  Anything else that is raised is our own bug.
    """
