"""The output as it runs: its thread, over UDP, TCP and a serial line of this computer."""

from __future__ import annotations

import os
import socket
import time
import tty
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from itertools import pairwise
from typing import Any

import pytest
from autopilot_peer import Peer, free_port, udp_peer, waiting
from autopilot_truth import AHEAD, BEHIND, detection, pose_at, tracked
from patience import until
from pymavlink.dialects.v20 import common as mavlink

from chromadock import Track
from chromadock.autopilot.output import AutopilotOutput
from chromadock.autopilot.settings import AutopilotSettings
from chromadock.autopilot.understood import understood

BODY = (4.0, 0.5, 0.2)
BOAT, SUBMARINE = mavlink.MAV_TYPE_SURFACE_BOAT, mavlink.MAV_TYPE_SUBMARINE
LATE_S = 0.03
"""From a frame to its detection."""


@contextmanager
def output(address: str, receiver: str = "ardupilot-rover", mounting: Any = AHEAD) -> Iterator[Any]:
    """The output, and the lines that it told."""
    told: list[str] = []
    settings = AutopilotSettings.parse(f"mavlink:{address}?receiver={receiver}")
    with AutopilotOutput(settings, mounting, told.append) as out:
        out.told = told
        yield out


def frame(out: AutopilotOutput, body: Any = BODY, **changes: Any) -> float:
    """One frame, taken a moment ago; its time."""
    time_s = time.monotonic() - LATE_S
    out.write(time_s, detection(tracked(time_s, pose_at(body), **changes)))
    return time_s


@contextmanager
def udp_link(mav_type: int = BOAT, receiver: str = "ardupilot-rover", autopilot: int = 3) -> Any:
    """An output that listens, and an autopilot that it has heard."""
    port = free_port()
    with output(f"udpin:127.0.0.1:{port}", receiver) as out:
        peer, end = udp_peer(port, mav_type, autopilot)
        with end:
            peer.until(lambda: peer.named("HEARTBEAT"))
            yield out, peer


def test_over_udp_a_rover_is_told_by_mavlink_2_as_component_191_of_its_own_system() -> None:
    with udp_link() as (out, peer):
        times_s: list[float] = []
        while len(peer.named("LANDING_TARGET")) < 5:
            times_s.append(frame(out))
            peer.step()
        targets = peer.named("LANDING_TARGET")
        for message in targets:
            assert (message.get_srcSystem(), message.get_srcComponent()) == (7, 191)
            assert message.get_msgbuf()[0] == 0xFD
            assert understood(out._settings.receiver, message).place == pytest.approx(BODY)
            assert min(abs(message.time_usec / 1e6 - t) for t in times_s) < 1e-6
        stamps = [message.time_usec for message in targets]
        assert stamps == sorted(set(stamps))
        sequence = [m.get_seq() for m in peer.messages]
        assert all((b - a) % 256 == 1 for a, b in pairwise(sequence))
        assert [m.text for m in peer.named("STATUSTEXT")] == ["Chromadock: dock locked, 4.0 m"]
        assert out.told == []
        latency_s = out.latency_s
        assert LATE_S <= latency_s < LATE_S + 0.02
    # ArduPilot cannot see the delay itself.
    assert out.told[0].endswith(f"the vehicle should have PLND_LAG {latency_s:.2f}")
    out.close()
    assert len(out.told) == 1


def test_at_most_the_set_number_of_frames_a_second_is_told() -> None:
    with udp_link() as (out, peer):
        start_s = time.monotonic()
        while time.monotonic() < start_s + 0.8:
            frame(out)  # each 20 ms
            peer.step()
        elapsed_s = time.monotonic() - start_s
        peer.step()
        assert 6 <= len(peer.named("LANDING_TARGET")) <= 15 * elapsed_s + 2


def test_a_sub_is_told_its_own_place_by_its_own_attitude_at_the_frames_time() -> None:
    with udp_link(SUBMARINE, "ardusub") as (out, peer):
        peer.yaw = 1.5707963
        for _ in range(30):
            peer.step()
        attitude = out.attitude(time.monotonic() - LATE_S)
        assert attitude is not None and attitude.yaw_rad == pytest.approx(1.5707963, abs=1e-6)
        frame(out)
        peer.until(lambda: peer.named("VISION_POSITION_ESTIMATE"))
        (message,) = peer.named("VISION_POSITION_ESTIMATE")
        assert understood(out._settings.receiver, message).place == pytest.approx(
            (0.5, -4.0, -0.2), abs=1e-5
        )
        assert peer.named("LANDING_TARGET") == []
        frame(out, body=(9.0, 0.0, 0.0))
        time.sleep(0.1)
        frame(out, body=(9.0, 0.0, 0.0))
        peer.until(lambda: len(peer.named("VISION_POSITION_ESTIMATE")) > 1)
        leapt = peer.named("VISION_POSITION_ESTIMATE")[-1]
        assert leapt.reset_counter == (message.reset_counter + 1) % 256
        told_ms = round(1000 * out.latency_s)
    assert out.told[-1].endswith(f"the vehicle should have VISO_DELAY_MS {told_ms}")


def test_px4_is_told_the_place_on_earth_and_odometry() -> None:
    with udp_link(mavlink.MAV_TYPE_QUADROTOR, "px4", autopilot=12) as (out, peer):
        peer.position = (10.0, 3.0, 1.0)
        for _ in range(10):
            peer.step()
        frame(out)
        peer.until(lambda: peer.named("ODOMETRY"))
        (target,) = peer.named("LANDING_TARGET")
        assert (target.x, target.y, target.z) == pytest.approx((14.0, 3.5, 1.2), abs=1e-5)
        assert out.told == []
        (odometry,) = peer.named("ODOMETRY")
        assert (odometry.x, odometry.y, odometry.z) == pytest.approx((-4.0, -0.5, -0.2), abs=1e-5)
    assert out.told == []  # it sees the delay by TIMESYNC


def test_the_crew_is_told_of_the_loss_and_then_nothing_is_sent() -> None:
    with udp_link() as (out, peer):
        frame(out)
        peer.until(lambda: peer.named("LANDING_TARGET"))
        later_s = time.monotonic() + 3.0
        out.write(later_s, detection(Track("lost", later_s, age_s=3.0)))
        peer.until(lambda: len(peer.named("STATUSTEXT")) == 2)
        assert peer.named("STATUSTEXT")[1].text == "Chromadock: dock lost"
        assert len(peer.named("LANDING_TARGET")) == 1


def test_a_frame_that_comes_twice_or_late_is_not_told() -> None:
    """The track has not used it, and is still that of the newest."""
    with udp_link() as (out, peer):
        time_s = frame(out)
        peer.until(lambda: peer.named("LANDING_TARGET"))
        newest = detection(tracked(time_s, pose_at(BODY)))
        for late_s in (0.0, 0.3, 0.5, 0.0, 0.7):
            out.write(time_s - late_s, newest)
            peer.step()
        peer.step()
        assert len(peer.named("LANDING_TARGET")) == 1


def test_questions_are_answered_while_no_frame_comes() -> None:
    with udp_link() as (_, peer):
        before_s = time.monotonic()
        peer.send(mavlink.MAVLink_timesync_message(0, 42))
        peer.send(mavlink.MAVLink_ping_message(1, 2, 0, 0))
        peer.send(mavlink.MAVLink_command_long_message(7, 191, 512, 0, 148, 0, 0, 0, 0, 0, 0))
        peer.until(lambda: peer.named("AUTOPILOT_VERSION"))
        (sync,) = peer.named("TIMESYNC")
        assert sync.ts1 == 42 and before_s < sync.tc1 / 1e9 < time.monotonic()
        assert peer.named("PING") and peer.named("COMMAND_ACK")[0].result == 0


def test_to_a_router_that_waits_the_heartbeat_goes_first_and_nothing_else() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as router:
        router.bind(("127.0.0.1", 0))
        router.settimeout(5)
        with output(f"udpout:127.0.0.1:{router.getsockname()[1]}") as out:
            frame(out)
            data, address = router.recvfrom(1000)
            router.connect(address)
            parser = mavlink.MAVLink(None)
            assert parser.parse_char(data).get_type() == "HEARTBEAT"
            peer = Peer(lambda: waiting(router), router.send, BOAT)
            peer.until(lambda: peer.named("HEARTBEAT"))
            assert peer.named("LANDING_TARGET") == []
            frame(out)
            peer.until(lambda: peer.named("LANDING_TARGET"))


def test_over_tcp_a_router_that_goes_away_is_told_once_and_found_again() -> None:
    port = free_port(socket.SOCK_STREAM)
    with output(f"tcp:127.0.0.1:{port}") as out:
        until(lambda: out.told)
        refused = "Connection refused: it is tried again until the vehicle is heard"
        assert out.told == [f"tcp:127.0.0.1:{port}: {refused}"]
        frame(out)  # nobody there: neither raises nor waits
        for round_ in range(2):
            with socket.create_server(("127.0.0.1", port)) as server:
                server.settimeout(15)
                end, _ = server.accept()
                with end:
                    # B023: each of these is called in the turn of the loop that makes it.
                    peer = Peer(lambda: waiting(end), end.sendall, BOAT)  # noqa: B023
                    peer.until(lambda: peer.named("HEARTBEAT"))  # noqa: B023
                    frame(out)
                    peer.until(lambda: peer.named("LANDING_TARGET"))  # noqa: B023
            until(lambda: len(out.told) == 3 + 2 * round_)  # noqa: B023
        back = f"tcp:127.0.0.1:{port}: heard the vehicle, system 7"
        assert out.told[1::2] == [back, back]
        assert "tried again" in out.told[2] and "tried again" in out.told[4]


class Board:
    """The autopilot's end of a serial line."""

    def __init__(self) -> None:
        self.end, self.port = os.openpty()
        tty.setraw(self.end)
        os.set_blocking(self.end, False)
        self.name = os.ttyname(self.port)

    def read(self) -> bytes:
        try:
            return os.read(self.end, 65536)
        except BlockingIOError:
            return b""

    def write(self, data: bytes) -> None:
        os.write(self.end, data)

    def pull(self) -> None:
        """The cable."""
        os.close(self.port)
        os.close(self.end)


def test_over_a_serial_line_it_is_the_same_and_a_cable_pulled_is_told() -> None:
    board = Board()
    with output(f"{board.name}:57600") as out:
        peer = Peer(board.read, board.write, BOAT)
        peer.until(lambda: peer.named("HEARTBEAT"))
        frame(out)
        peer.until(lambda: peer.named("LANDING_TARGET"))
        assert out.told == []
        board.pull()
        until(lambda: out.told)
        assert out.told[0].startswith(f"{board.name}:57600: ") and "tried again" in out.told[0]
        frame(out)


def test_a_line_that_takes_no_more_bytes_does_not_hold_up_the_frames() -> None:
    board = Board()
    with output(f"{board.name}:57600") as out:
        peer = Peer(board.read, board.write, BOAT)
        peer.until(lambda: peer.named("HEARTBEAT"))
        # Answers to so many questions fill the line, and nobody reads them.
        longest_s, end_s = 0.0, time.monotonic() + 10
        while not out.told and time.monotonic() < end_s:
            with suppress(BlockingIOError):
                for _ in range(20):
                    peer.send(mavlink.MAVLink_ping_message(1, 2, 0, 0))
            before_s = time.monotonic()
            frame(out)
            longest_s = max(longest_s, time.monotonic() - before_s)
            time.sleep(0.002)
        assert len(out.told) == 1 and "timeout" in out.told[0].lower()
        assert longest_s < 0.5
        before_s = time.monotonic()
    assert time.monotonic() - before_s < 3.0
    board.pull()


UNOPENED = {
    "udpout:no.such.host.invalid:14550": "",  # the resolver's words
    "/dev/no-such-port:57600": "No such file or directory",
    "/dev/null": "",  # pyserial's words
    "udpin:192.0.2.1:14550": "Cannot assign requested address",
}


def test_what_cannot_be_opened_is_told_in_one_line_and_holds_nobody_up(
    capfd: pytest.CaptureFixture[str],
) -> None:
    with ExitStack() as stack:
        outs = {address: stack.enter_context(output(address)) for address in UNOPENED}
        until(lambda: all(out.told for out in outs.values()))
        before_s = time.monotonic()
        for _ in range(20):
            for out in outs.values():
                frame(out)
        assert time.monotonic() - before_s < 1.0
        time.sleep(0.7)  # they are tried again meanwhile
        for address, out in outs.items():
            assert len(out.told) == 1 and "\n" not in out.told[0]
            assert out.told[0].startswith(f"{out._settings.address}: ")
            assert UNOPENED[address] in out.told[0]
    assert capfd.readouterr() == ("", "")


def test_frames_without_a_track_and_of_another_clock_are_told_of_once() -> None:
    with udp_link() as (out, peer):
        for _ in range(3):
            out.write(time.monotonic(), detection(None))
        assert len(out.told) == 1 and "no track" in out.told[0]
        for k in range(8):
            out.write(k / 10, detection(tracked(k / 10, pose_at(BODY))))
            peer.step()
            time.sleep(0.08)
        assert len(out.told) == 2 and "monotonic" in out.told[1]
        now_s = time.monotonic()
        stamps = [m.time_usec / 1e6 for m in peer.named("LANDING_TARGET")]
        assert len(stamps) >= 5 and all(now_s - 2 < stamp <= now_s for stamp in stamps)
        assert out.latency_s is None


def test_frames_of_a_cameras_own_clock_that_tell_their_age_need_no_word() -> None:
    with udp_link() as (out, peer):
        start_s = time.monotonic() - LATE_S
        for k in range(8):
            age_s = time.monotonic() - start_s - k / 10
            out.write(k / 10, detection(tracked(k / 10, pose_at(BODY))), age_s)
            peer.step()
            time.sleep(0.08)
        peer.step()
        assert out.told == [] and LATE_S <= out.latency_s < LATE_S + 0.05
        stamps = [m.time_usec / 1e6 - start_s for m in peer.named("LANDING_TARGET")]
        assert len(stamps) >= 5
        assert all(abs(stamp - round(stamp, 1)) < 0.001 for stamp in stamps)


def test_a_camera_behind_a_rover_needs_a_parameter_and_it_is_said() -> None:
    with output(f"udpin:127.0.0.1:{free_port()}", mounting=BEHIND) as out:
        assert len(out.told) == 1 and "PLND_ORIENT 4" in out.told[0]
