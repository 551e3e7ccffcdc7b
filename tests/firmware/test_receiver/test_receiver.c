/* The receiver by itself: whole messages out of a sound stream of bytes. */
#include "receiver_fixture.h"
#include "suite.h"

static void test_each_message_is_found(void)
{
    start();
    for (int kind = 0; kind < KINDS; kind++)
        put_wire(one_of(kind));
    TEST_ASSERT_EQUAL_UINT(KINDS, found_count);
    for (int kind = 0; kind < KINDS; kind++)
        assert_found((size_t)kind, one_of(kind));
    TEST_ASSERT_EQUAL_UINT32(0, receiver.rejected);
}

static void test_one_byte_at_a_time_is_the_same_as_all_at_once(void)
{
    start();
    for (int kind = 0; kind < KINDS; kind++) {
        const wire_t wire = one_of(kind);
        for (size_t i = 0; i < wire.length; i++) {
            TEST_ASSERT_EQUAL_UINT((size_t)kind, found_count);
            put(wire.bytes + i, 1);
        }
        assert_found((size_t)kind, wire);
    }
}

static void test_pieces_of_any_length_are_the_same_as_all_at_once(void)
{
    uint8_t stream[4 * 280];
    for (size_t piece = 1; piece < 300; piece += 7) {
        size_t n = 0;
        start();
        for (int kind = 0; kind < KINDS; kind++) {
            const wire_t wire = one_of(kind);
            memcpy(stream + n, wire.bytes, wire.length);
            n += wire.length;
        }
        for (size_t at = 0; at < n; at += piece)
            put(stream + at, n - at < piece ? n - at : piece);
        TEST_ASSERT_EQUAL_UINT(KINDS, found_count);
        for (int kind = 0; kind < KINDS; kind++)
            assert_found((size_t)kind, one_of(kind));
    }
}

static void test_a_duplicate_is_found_twice(void)
{
    start();
    put_wire(one_of(3));
    put_wire(one_of(3));
    TEST_ASSERT_EQUAL_UINT(2, found_count);
    assert_found(1, one_of(3));
}

static void test_signed_messages_are_read_like_others(void)
{
    start();
    host.sign = true;
    for (int kind = 0; kind < KINDS; kind++) {
        const wire_t wire = one_of(kind);
        TEST_ASSERT_EQUAL_UINT8(1, wire.bytes[2]);
        TEST_ASSERT_EQUAL_UINT(10u + wire.bytes[1] + 2 + 13, wire.length);
        for (size_t i = 0; i < wire.length; i++) {
            TEST_ASSERT_EQUAL_UINT((size_t)kind, found_count);
            put(wire.bytes + i, 1);
        }
        assert_found((size_t)kind, wire);
    }
    TEST_ASSERT_EQUAL_UINT(0, receiver.length);
    TEST_ASSERT_EQUAL_UINT32(0, receiver.rejected);
}

static void test_unknown_messages_are_passed_over(void)
{
    const mavlink_heartbeat_t heartbeat = {.type = MAV_TYPE_GCS};
    const mavlink_ping_t ping = {.seq = 5};
    mavlink_message_t message;
    start();
    mavlink_msg_heartbeat_encode(255, 190, &message, &heartbeat);
    put_wire(wire_of(&message));
    mavlink_msg_ping_encode(255, 190, &message, &ping);
    put_wire(wire_of(&message));
    put_wire(one_of(0));
    TEST_ASSERT_EQUAL_UINT(1, found_count);
    TEST_ASSERT_EQUAL_UINT32(0, receiver.rejected);
}

static void test_flags_that_nobody_knows_make_it_no_message(void)
{
    for (int flag = 1; flag < 8; flag++) {
        wire_t wire = one_of(0);
        start();
        wire.bytes[2] = (uint8_t)(1u << flag);
        uint16_t sum =
            crc_calculate(wire.bytes + 1, (uint16_t)(wire.length - 3));
        crc_accumulate(MAVLINK_MSG_ID_PARAM_SET_CRC, &sum);
        wire.bytes[wire.length - 2] = (uint8_t)sum;
        wire.bytes[wire.length - 1] = (uint8_t)(sum >> 8);
        put_wire(wire);
        TEST_ASSERT_EQUAL_UINT(0, found_count);
    }
}

/* Half a message, then a whole one within the patience or after it. */
static void halves(uint32_t begin, uint32_t pause, size_t expected)
{
    const wire_t wire = one_of(0);
    start();
    now = begin;
    put(wire.bytes, 12);
    now += pause;
    put(NULL, 0);
    put(wire.bytes + 12, wire.length - 12);
    TEST_ASSERT_EQUAL_UINT(expected, found_count);
}

static void test_a_half_message_is_given_up_by_the_clock(void)
{
    halves(1000, 0, 1);
    halves(1000, RECEIVER_PATIENCE_MS, 1);
    halves(1000, RECEIVER_PATIENCE_MS + 1, 0);
}

static void test_the_clock_may_wrap_between_two_halves(void)
{
    halves(UINT32_MAX - 10, RECEIVER_PATIENCE_MS, 1);
    halves(UINT32_MAX - 10, RECEIVER_PATIENCE_MS + 1, 0);
    halves(UINT32_MAX, 1, 1);
    halves(UINT32_MAX - 10, 5, 1); /* the end of the patience is beyond it */
    halves(UINT32_MAX - 300, 400, 0);
}

static void run_tests(void)
{
    RUN_TEST(test_each_message_is_found);
    RUN_TEST(test_one_byte_at_a_time_is_the_same_as_all_at_once);
    RUN_TEST(test_pieces_of_any_length_are_the_same_as_all_at_once);
    RUN_TEST(test_a_duplicate_is_found_twice);
    RUN_TEST(test_signed_messages_are_read_like_others);
    RUN_TEST(test_unknown_messages_are_passed_over);
    RUN_TEST(test_flags_that_nobody_knows_make_it_no_message);
    RUN_TEST(test_a_half_message_is_given_up_by_the_clock);
    RUN_TEST(test_the_clock_may_wrap_between_two_halves);
}

SUITE(run_tests)
