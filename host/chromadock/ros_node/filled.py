"""From fields to the message objects of ROS 2."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from chromadock.ros.fields import Fields


def message_class(kind: str) -> type[Any]:
    """The class of a type such as ``sensor_msgs/msg/Image`` or ``sensor_msgs/Image``.

    Raises
    ------
    ImportError
        Where the package of that message is not installed.
    """
    package, _, name = kind.partition("/")
    found: type[Any] = getattr(import_module(f"{package}.msg"), name.removeprefix("msg/"))
    return found


def filled(kind: type[Any], fields: Fields) -> Any:
    """A message of a class, with its fields, messages in it too.

    Raises
    ------
    ValueError
        Where a field is missing or there is none of that name: a slip in the code.
    """
    described: dict[str, str] = kind.get_fields_and_field_types()
    if described.keys() != fields.keys():
        given = ", ".join(fields)
        raise ValueError(f"{kind.__name__} has {', '.join(described)}, but was given {given}")
    return kind(**{name: _value(described[name], value) for name, value in fields.items()})


def _value(described: str, value: Any) -> Any:
    """A value as its type has it: ``double[36]``, say, or ``sequence<std_msgs/Header>``."""
    if described == "octet":
        return bytes([value])
    element = described.removeprefix("sequence<").split(",")[0].rstrip(">")
    if "/" not in element:
        return value
    kind = message_class(element)
    return [filled(kind, one) for one in value] if isinstance(value, list) else filled(kind, value)
