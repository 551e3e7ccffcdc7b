"""Addresses as they may be shown: in messages, in frames' names, in lines of JSON."""

from __future__ import annotations

import re

_ADDRESS = re.compile(r"(?P<scheme>[A-Za-z][A-Za-z0-9+.-]+):/+(?P<rest>.*)", re.DOTALL)
_SECRET_FROM = re.compile(r"[?#;]|[^/?#;]*=")
"""Where a query, a fragment or a parameter begins; some cameras have them in the path, as in
``/user=admin&password=1234&channel=1``."""


def without_secrets(text: str) -> str:
    """``text`` without what may be a password or a token of an address in it.

    Of an address scheme, host, port and path stay: ``...`` stands for the user's name and
    password, and for everything from the first query, fragment or parameter on.  A password may
    itself have an ``@``, a ``/`` or a ``?``, so all up to the last ``@`` is taken for it.
    Any other text comes back as it is, unless it has a colon before an ``@``, as an address
    whose scheme was forgotten.
    """
    address = _ADDRESS.match(text)
    if address is None:
        return "...@" + _public(text.rpartition("@")[2]) if re.search(":.*@", text) else text
    _, at, rest = address["rest"].rpartition("@")
    return f"{address['scheme']}://{'...@' if at else ''}{_public(rest)}"


def _public(rest: str) -> str:
    """Host, port and path."""
    secret = _SECRET_FROM.search(rest)
    return rest if secret is None else rest[: secret.start()] + "..."
