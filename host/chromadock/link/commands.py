"""COMMAND_LONG to the dock, and its COMMAND_ACK."""

from __future__ import annotations

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link.framing import Message
from chromadock.link.messenger import DOCK_COMPONENT, DOCK_SYSTEM, Messenger

SLOW_S = 10.0
"""For a command that the dock said it is at: a board's flash takes four seconds."""
_SLOW_AGAIN_S = 2.0

_REFUSALS = {
    dialect.MAV_RESULT_TEMPORARILY_REJECTED: "is busy: try again in a moment",
    dialect.MAV_RESULT_DENIED: "refuses those values: correct them",
    dialect.MAV_RESULT_UNSUPPORTED: "does not know that command: flash this version's firmware",
    dialect.MAV_RESULT_FAILED: "could not do it: restart the dock and try again",
}


def command(messenger: Messenger, number: int, what: str, *values: float) -> None:
    """Send a command with its parameters 1, 2, ... until it is acknowledged.

    A dock that is at it is waited for, ``SLOW_S`` at most.

    Raises
    ------
    ChromadockError
        Where the dock does not answer or refuses; ``what`` names the command.
    """
    request = command_long(number, *values)
    heard = messenger.last_text
    ack = messenger.ask(request, lambda m: _acknowledges(m, number), what)
    if ack.result == dialect.MAV_RESULT_IN_PROGRESS:
        ack = _finished(messenger, request, what)
    if ack.result != dialect.MAV_RESULT_ACCEPTED:
        said = messenger.last_text if messenger.last_text != heard else ""
        refusal = _REFUSALS.get(ack.result, f"answers with result {ack.result}: see its messages")
        raise ChromadockError(
            f"{messenger.connection.url}: {what}: the dock "
            + (f"says: {said}: correct the values" if said else refusal)
        )


def _finished(messenger: Messenger, request: Message, what: str) -> Message:
    """The last answer to a command that takes its time; asking again is asking for the same."""

    def last(message: Message) -> bool:
        final = _acknowledges(message, request.command)
        return final and bool(message.result != dialect.MAV_RESULT_IN_PROGRESS)

    end = messenger.clock() + SLOW_S
    while (left_s := end - messenger.clock()) > 0:
        ack = messenger.wait(last, min(_SLOW_AGAIN_S, left_s))
        if ack is not None:
            return ack
        messenger.send(request)
    raise messenger.silent(what)


def ask_for_message(messenger: Messenger, number: int, name: str) -> Message:
    """A message that the dock made after this was called.

    Raises
    ------
    ChromadockError
        Where it does not come.
    """
    acknowledged = False

    def ours(message: Message) -> bool:
        nonlocal acknowledged
        # The dock sends acknowledgements before reports: what comes earlier is older.
        acknowledged = acknowledged or _acknowledges(message, dialect.MAV_CMD_REQUEST_MESSAGE)
        return acknowledged and bool(message.get_type() == name)

    request = command_long(dialect.MAV_CMD_REQUEST_MESSAGE, number)
    return messenger.ask(request, ours, f"a request for {name}")


def command_long(number: int, *values: float) -> Message:
    """The message of a command, to a dock of the default system; parameters left out are 0."""
    parameters = [*map(float, values), *[0.0] * (7 - len(values))]
    return dialect.MAVLink_command_long_message(DOCK_SYSTEM, DOCK_COMPONENT, number, 0, *parameters)


def _acknowledges(message: Message, number: int) -> bool:
    return bool(message.get_type() == "COMMAND_ACK" and message.command == number)
