"""A text that two values share only if they are equal: what digests are made of."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np


def fingerprint(value: Any) -> str:
    """The same in every process and on every machine, unlike ``hash`` and ``pickle``.

    Raises
    ------
    TypeError
        For anything but dataclasses, arrays, tuples, lists, mappings, texts and numbers.
    """
    if isinstance(value, (str, bytes, int, float, Path, np.generic)) or value is None:
        return f"{type(value).__name__}:{value!r}"
    if isinstance(value, np.ndarray):
        bits = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        return f"array:{value.dtype.str}{value.shape}{bits}"
    if isinstance(value, (tuple, list)):
        return f"[{','.join(fingerprint(item) for item in value)}]"
    if isinstance(value, Mapping):
        pairs = sorted((fingerprint(k), fingerprint(v)) for k, v in value.items())
        return f"{{{','.join(f'{k}={v}' for k, v in pairs)}}}"
    if is_dataclass(value):
        content = {f.name: getattr(value, f.name) for f in fields(value)}
        return f"{type(value).__qualname__}{fingerprint(content)}"
    raise TypeError(f"no fingerprint of {type(value)}")
