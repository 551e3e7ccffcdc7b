"""The dock's parameters over MAVLink's parameter protocol, all of them REAL32."""

from __future__ import annotations

import struct

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link.framing import Message
from chromadock.link.messenger import DOCK_COMPONENT, DOCK_SYSTEM, Messenger
from chromadock.link.values import TABLE, show, step

_LIST_QUIET_S = 0.3


def fetch_all(messenger: Messenger) -> dict[str, float]:
    """Every parameter by name, in the dock's order.

    Raises
    ------
    ChromadockError
        Where some do not come in spite of asking again.
    """
    values: dict[int, tuple[str, float]] = {}
    count: int | None = None
    end = messenger.clock() + messenger.patience_s
    while messenger.clock() < end:
        _request_missing(messenger, values, count)
        while count is None or len(values) < count:
            message = messenger.wait(_is_value, _LIST_QUIET_S)
            if message is None:
                break
            count = message.param_count
            if message.param_index < message.param_count:
                values[message.param_index] = (message.param_id, message.param_value)
                end = messenger.clock() + messenger.patience_s
        if count is not None and len(values) >= count:
            return dict(values[index] for index in sorted(values))
    raise messenger.silent("a request for its parameters")


def fetch(messenger: Messenger, name: str) -> float:
    """One parameter's value.

    Raises
    ------
    ChromadockError
        Where the dock does not answer.
    """
    answer = messenger.ask(
        _request(name.encode("ascii"), -1),
        lambda m: _is_value(m) and m.param_id == name,
        f"a request for {name}",
    )
    return float(answer.param_value)


def assign(messenger: Messenger, name: str, value: float) -> float:
    """Set a parameter and return what the dock took: ``value`` at its nearest step.

    Raises
    ------
    ChromadockError
        Where the dock refuses it or does not answer.
    """
    value = struct.unpack("<f", struct.pack("<f", value))[0]
    request = dialect.MAVLink_param_set_message(
        DOCK_SYSTEM,
        DOCK_COMPONENT,
        name.encode("ascii"),
        value,
        dialect.MAV_PARAM_TYPE_REAL32,
    )
    heard = messenger.last_text
    row = TABLE[name]
    tolerance = 0.51 * step(row)
    for _ in range(2):  # the first answer may be one to an earlier request
        answer = messenger.ask(
            request, lambda m: _is_value(m) and m.param_id == name, f"setting {name}"
        )
        if abs(answer.param_value - value) <= tolerance:
            return float(answer.param_value)
    said = messenger.last_text if messenger.last_text != heard else "no reason"
    raise ChromadockError(
        f"{messenger.connection.url}: {name} stays {show(row, answer.param_value)}, "
        f"the dock says: {said}: give another value"
    )


def _request_missing(
    messenger: Messenger, values: dict[int, tuple[str, float]], count: int | None
) -> None:
    if count is None:
        messenger.send(dialect.MAVLink_param_request_list_message(DOCK_SYSTEM, DOCK_COMPONENT))
        return
    for index in range(count):
        if index not in values:
            messenger.send(_request(b"", index))


def _is_value(message: Message) -> bool:
    return bool(message.get_type() == "PARAM_VALUE")


def _request(name: bytes, index: int) -> Message:
    return dialect.MAVLink_param_request_read_message(DOCK_SYSTEM, DOCK_COMPONENT, name, index)
