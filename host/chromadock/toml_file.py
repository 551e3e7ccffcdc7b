"""Reads the TOML files that users write."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from chromadock.errors import ChromadockError
from chromadock.text import one_line
from chromadock.text_file import read_text
from chromadock.validation import explain

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def read_toml(path: str | Path, mend: str = "give a TOML file") -> dict[str, Any]:
    """The keys and values of a TOML file; ``mend`` says what file is wanted.

    Raises
    ------
    ChromadockError
        One line with the file, what is wrong and the mend.
    """
    try:
        return tomllib.loads(read_text(path))
    except OSError as error:
        raise ChromadockError(f"{path}: cannot be read ({error.strerror}): {mend}") from None
    except UnicodeDecodeError:
        raise ChromadockError(f"{path}: not a text file: {mend}") from None
    except tomllib.TOMLDecodeError as error:
        raise ChromadockError(
            f"{path}: not valid TOML ({one_line(error)}): correct that line"
        ) from None


def change(text: str, example: str) -> tuple[str, Any]:
    """The dotted key and the value of a command line's ``--set key=value``, written as in TOML;
    words need no quotes.  ``example`` stands in the message.

    Raises
    ------
    ChromadockError
        Where there is no key.
    """
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise ChromadockError(f"--set {text}: write key=value, e.g. {example}")
    try:
        return key.strip(), tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return key.strip(), value.strip()


def one_line_error(path: str | Path, error: ValidationError) -> ChromadockError:
    """The first fault of a file: its name, the key, what stands there, what may stand there."""
    return ChromadockError(f"{path}: {explain(error)}")
