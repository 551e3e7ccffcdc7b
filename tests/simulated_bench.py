"""A simulated dock on a desk: time is an argument, so nothing here waits."""

from simulation import packed

from chromadock import dialect
from chromadock.link.commands import command_long
from chromadock.link.framing import FrameFinder
from chromadock.simulated import SimulatedDock, parse_fault
from chromadock.simulated.camera import open_camera

HOST = {"system": 255, "component": 190}

SAVE = command_long(dialect.MAV_CMD_PREFLIGHT_STORAGE, 1)

REBOOT = command_long(dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)


class Bench:
    """A dock on a desk, and a host that hears all it says."""

    def __init__(self, *faults, start_s=0.0, source=None, **options):
        self.now_s = start_s
        options.setdefault("save_s", 0.1)
        self.dock = SimulatedDock(
            open_camera(source), faults=[parse_fault(f) for f in faults], now_s=start_s, **options
        )
        self.finder = FrameFinder()
        self.bytes = b""
        self.messages = []

    def run(self, seconds, step_s=0.02):
        end_s = self.now_s + seconds
        while self.now_s < end_s:
            self.now_s += step_s
            self.dock.step(self.now_s)
            out = self.dock.transmit(self.now_s)
            self.bytes += out
            self.messages += self.finder.feed(out)
        return self

    def send(self, *messages):
        self.dock.receive(packed(*messages, **HOST), self.now_s)
        return self.run(0.2)

    def status(self):
        return self.all("DOCK_STATUS")[-1]

    def all(self, kind):
        return [m for m in self.messages if m.get_type() == kind]

    def said(self):
        return [m.text for m in self.all("STATUSTEXT")]

    def result(self):
        return self.all("COMMAND_ACK")[-1].result


def parameter(name, value):
    return dialect.MAVLink_param_set_message(
        50, 1, name.encode(), value, dialect.MAV_PARAM_TYPE_REAL32
    )


def limit(value):
    return parameter("LED_LIMIT", value)


def led_limit(bench):
    bench.send(dialect.MAVLink_param_request_read_message(50, 1, b"LED_LIMIT", -1))
    return bench.all("PARAM_VALUE")[-1].param_value
