"""What pydantic finds wrong in a file, said in one line with what is allowed."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, ValidationError, ValidatorFunctionWrapHandler
from pydantic_core import PydanticCustomError, core_schema

from chromadock.text import one_line


@dataclass(frozen=True)
class Wanted:
    """Annotates a key with what may stand there, in words, and with what checks it."""

    words: str
    check: Callable[[Any, ValidatorFunctionWrapHandler], Any]

    def __get_pydantic_core_schema__(
        self, source: type[Any], handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """How pydantic comes to the check."""
        return core_schema.no_info_wrap_validator_function(self.check, handler(source))


def between(low: float, high: float, unit: str = "", words: tuple[str, ...] = ()) -> Wanted:
    """Annotates a number: whatever is wrong with it, the message gives the whole range.

    ``words``: texts that may stand there instead.
    """
    wanted = f"{low:g} to {high:g} {unit}".rstrip()
    if words:
        wanted = f"{', '.join(json.dumps(word) for word in words)} or {wanted}"

    def check(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
        if isinstance(value, str) and value in words:
            return value
        try:
            # Pydantic would take True and "3" for numbers.
            number = handler(value) if type(value) in (int, float) else math.nan
        except ValidationError:
            number = math.nan
        if not low <= number <= high:
            raise _refusal(wanted)
        return number

    return Wanted(wanted, check)


def allowed(wanted: str) -> Wanted:
    """Annotates a key: whatever is wrong with it, the message says ``it must be <wanted>``."""

    def check(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
        try:
            return handler(value)
        except ValidationError:
            raise _refusal(wanted) from None

    return Wanted(wanted, check)


def explain(error: ValidationError) -> str:
    """The first fault: the key, what stands there, what may stand there."""
    fault: Any = error.errors()[0]
    where, kind = place(fault["loc"]), fault["type"]
    if kind in ("extra_forbidden", "unexpected_keyword_argument"):
        return f"unknown key {where}: correct or remove it"
    if kind == "missing":
        return f"{where} is missing"
    if kind == "value_error":  # a check of several keys, which its words name
        return ": ".join(filter(None, (where, one_line(fault["ctx"]["error"]))))
    return f"{where} is {shown(fault['input'])}: it must be {wording(fault)}"


def place(loc: tuple[int | str, ...]) -> str:
    """Where a fault is: ``control.tint, number 2`` or ``marker 4: position``."""
    words = ""
    for i, part in enumerate(loc):
        if isinstance(part, int):
            words += f", number {part + 1}" if i == len(loc) - 1 else f" {part + 1}"
        elif not words:
            words = part
        else:
            words += f": {part}" if isinstance(loc[i - 1], int) else f".{part}"
    return words


def shown(value: object) -> str:
    """A value as a user wrote it, cut short."""
    return one_line(repr(value), 40)


def wording(fault: Any) -> str:
    """What pydantic wants in the place of a fault, to follow "it must be"."""
    template = _WANTED.get(fault["type"])
    if template is not None:
        return template.format(**fault.get("ctx", {}))
    return one_line(str(fault["msg"]).removeprefix("Input should be "))


_WANTED = {
    "greater_than": "more than {gt:g}",
    "greater_than_equal": "at least {ge:g}",
    "less_than": "less than {lt:g}",
    "less_than_equal": "at most {le:g}",
    "finite_number": "a finite number",
    "too_short": "a list of at least {min_length}",
    "too_long": "a list of at most {max_length}",
    "list_type": "a list",
    "tuple_type": "a list",
    "model_type": "a table of keys",
    "dataclass_type": "a table of keys",
}


def _refusal(wanted: str) -> PydanticCustomError:
    return PydanticCustomError("not_allowed", "{wanted}", {"wanted": wanted})
