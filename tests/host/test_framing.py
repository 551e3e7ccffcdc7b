"""The finder of messages among anything else."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.generator.mavcrc import x25crc
from simulation import heartbeat, packed

from chromadock import dialect
from chromadock.link.framing import FrameFinder


def value(index):
    return dialect.MAVLink_param_value_message(
        b"LED_LIMIT", float(index), dialect.MAV_PARAM_TYPE_REAL32, 26, index % 26
    )


def text(index):
    return dialect.MAVLink_statustext_message(4, b"camera gives no frame %d" % index)


def data(index):
    return dialect.MAVLink_encapsulated_data_message(index, bytes([index % 256, 0xFD] * 126) + b"1")


kinds = st.sampled_from([value, text, data])
streams = st.lists(st.tuples(kinds, st.integers(0, 999)), min_size=3, max_size=6).map(
    lambda picked: [packed(kind(index)) for kind, index in picked]
)
printed = st.text(st.characters(min_codepoint=9, max_codepoint=126), max_size=60).map(str.encode)


def found(*pieces):
    finder = FrameFinder()
    messages = [m for piece in pieces for m in finder.feed(piece)]
    return [bytes(m.get_msgbuf()) for m in messages + finder.give_up()]


@given(streams, st.integers(1, 40))
def test_messages_are_found_whatever_pieces_they_come_in(stream, size):
    whole = b"".join(stream)
    assert found(*(whole[i : i + size] for i in range(0, len(whole), size))) == stream


@given(streams, st.lists(printed, min_size=7, max_size=7))
def test_text_between_messages_costs_none(stream, texts):
    mixed = [part for pair in zip(texts, stream, strict=False) for part in pair]
    assert found(b"".join(mixed) + texts[-1]) == stream


@given(streams, st.data())
def test_text_inside_a_message_costs_only_that_one(stream, draw):
    hit = draw.draw(st.integers(0, len(stream) - 1))
    at = draw.draw(st.integers(1, len(stream[hit]) - 1))
    words = draw.draw(printed.filter(len))
    damaged = [*stream]
    damaged[hit] = stream[hit][:at] + words + stream[hit][at:]
    assert found(b"".join(damaged)) == stream[:hit] + stream[hit + 1 :]


@given(streams, st.data())
def test_a_truncated_message_costs_only_itself(stream, draw):
    hit = draw.draw(st.integers(0, len(stream) - 1))
    cut = draw.draw(st.integers(1, len(stream[hit]) - 1))
    damaged = [*stream]
    damaged[hit] = stream[hit][:cut]
    assert found(b"".join(damaged)) == stream[:hit] + stream[hit + 1 :]


@given(streams, st.data())
def test_a_changed_byte_costs_only_its_message(stream, draw):
    hit = draw.draw(st.integers(0, len(stream) - 1))
    at = draw.draw(st.integers(0, len(stream[hit]) - 1))
    damaged = [bytearray(part) for part in stream]
    damaged[hit][at] ^= draw.draw(st.integers(1, 255))
    assert found(b"".join(damaged)) == stream[:hit] + stream[hit + 1 :]


@given(streams, st.data())
def test_bytes_that_come_twice_cost_only_their_message(stream, draw):
    hit = draw.draw(st.integers(0, len(stream) - 1))
    start = draw.draw(st.integers(0, len(stream[hit]) - 2))
    end = draw.draw(st.integers(start + 1, len(stream[hit]) - (start == 0)))
    again = stream[hit][:end] + stream[hit][start:]
    others = found(b"".join([*stream[:hit], again, *stream[hit + 1 :]]))
    rest = stream[:hit] + stream[hit + 1 :]
    assert others == rest or others == stream  # a repeated start still ends in a whole one


@given(streams)
def test_a_message_that_comes_twice_is_found_twice(stream):
    assert found(b"".join(part + part for part in stream)) == [m for m in stream for _ in "12"]


@given(st.binary(max_size=600), streams)
def test_noise_costs_no_message_behind_it(noise, stream):
    behind = found(noise + b"".join(stream))
    assert behind[-len(stream) :] == stream


@given(st.lists(st.binary(max_size=80), max_size=8), streams)
def test_every_byte_is_either_skipped_or_part_of_a_message(noise, stream):
    mixed = b"".join(n + m for n, m in zip(noise, stream, strict=False))
    finder = FrameFinder()
    messages = finder.feed(mixed) + finder.give_up()
    assert finder.skipped + sum(len(m.get_msgbuf()) for m in messages) == len(mixed)


def test_a_false_start_does_not_hold_up_what_follows_for_ever():
    finder = FrameFinder()
    # Claims 255 bytes of a message that is known.
    false = bytes([0xFD, 255, 0, 0, 0, 50, 1]) + (131).to_bytes(3, "little")
    assert finder.feed(false + packed(heartbeat())) == []
    assert [m.get_type() for m in finder.give_up()] == ["HEARTBEAT"]


def test_an_unknown_message_and_mavlink_1_are_passed_over():
    unknown = bytearray(packed(heartbeat()))
    unknown[7:10] = (16_000_000).to_bytes(3, "little")
    old = heartbeat().pack(dialect.MAVLink(None, 50, 1), force_mavlink1=True)
    known = packed(value(3))
    assert found(bytes(unknown) + bytes(old) + known) == [known]


def test_a_signed_message_is_found_with_its_signature():
    mav = dialect.MAVLink(None, 50, 1)
    mav.signing.secret_key = b"k" * 32
    mav.signing.sign_outgoing = True
    signed = bytes(text(1).pack(mav))
    plain = packed(text(2))
    assert found(signed + plain) == [signed, plain]


def test_a_wrong_checksum_is_counted_by_message_even_if_pymavlink_is_told_to_ignore_it(
    monkeypatch,
):
    monkeypatch.setattr(dialect, "MAVLINK_IGNORE_CRC", 1)
    finder = FrameFinder()
    damaged = bytearray(packed(value(3)))
    damaged[-1] ^= 1
    assert finder.feed(bytes(damaged)) == []
    assert finder.rejected[dialect.MAVLINK_MSG_ID_PARAM_VALUE] == 1


def test_fields_come_as_they_were_sent():
    (message,) = FrameFinder().feed(packed(value(7)))
    assert (message.get_type(), message.param_id) == ("PARAM_VALUE", "LED_LIMIT")
    assert (message.param_value, message.param_index) == (7.0, 7)
    assert message.get_srcSystem() == dialect.DOCK_ID_SYSTEM
    assert struct.pack("<f", message.param_value) in packed(value(7))


def around(inner, number, crc_extra):
    """A message of any id whose payload is another one, whole."""
    header = bytes([0xFD, len(inner), 0, 0, 7, 1, 1]) + number.to_bytes(3, "little")
    crc = x25crc(header[1:] + inner)
    crc.accumulate(bytes([crc_extra]))
    return header + inner + crc.crc.to_bytes(2, "little")


@pytest.mark.parametrize("number", [dialect.MAVLINK_MSG_ID_TUNNEL, 11020])
def test_what_another_message_carries_is_not_found(number):
    inner = packed(dialect.MAVLink_param_value_message(b"LED_LIMIT", 1.0, 9, 27, 18))
    known = dialect.mavlink_map.get(number)
    outer = around(inner.ljust(133, b"\0"), number, known.crc_extra if known else 99)
    finder = FrameFinder()
    found = finder.feed(outer + outer + inner)
    assert [m.get_type() for m in found if m.get_type() != "TUNNEL"] == ["PARAM_VALUE"]
    finder.feed(outer)
    assert finder.give_up() == []
