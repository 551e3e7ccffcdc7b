"""What another end of a dock's line says, for ``simulation.peer``."""

from chromadock import dialect, method
from chromadock.link.framing import FrameFinder


def version(digest=method.DIGEST):
    return dialect.MAVLink_autopilot_version_message(
        0, 0, 0, 0, 0, [*b"abcdef12"], [*reversed(bytes.fromhex(digest))], [0] * 8, 0, 0, 0
    )


def answering(answers):
    """A peer's script: for each message of the host, what ``answers`` returns."""

    def script(client):
        finder = FrameFinder()
        while data := client.recv(4096):
            for message in finder.feed(data):
                client.sendall(answers(message))

    return script
