"""Factors of drawn scenes that a tool's user fixes."""

from __future__ import annotations

from collections.abc import Sequence

from chromadock.errors import ChromadockError
from chromadock.variety.factors import check_names


def fixed_factors(pairs: Sequence[str]) -> dict[str, str | float]:
    """Of ``name=value``, each checked to be a factor.

    Raises
    ------
    ChromadockError
        For one that is not written so, or a factor that there is not.
    """
    fixed: dict[str, str | float] = {}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals:
            raise ChromadockError(f"--fixed {pair}: write it as name=value")
        fixed[name] = value
    check_names(fixed)
    return fixed
