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

/* A message of any id whose payload is another one, whole. */
static wire_t around(wire_t inner, uint32_t id, uint8_t crc_extra)
{
    wire_t wire = {{MAVLINK_STX, (uint8_t)inner.length, 0, 0, 7, 1, 1,
                    (uint8_t)id, (uint8_t)(id >> 8), (uint8_t)(id >> 16)},
                   inner.length + 12};
    memcpy(wire.bytes + 10, inner.bytes, inner.length);
    uint16_t sum = crc_calculate(wire.bytes + 1, (uint16_t)(inner.length + 9));
    crc_accumulate(crc_extra, &sum);
    wire.bytes[inner.length + 10] = (uint8_t)sum;
    wire.bytes[inner.length + 11] = (uint8_t)(sum >> 8);
    return wire;
}

enum { UNKNOWN_ID = 11020 }; /* of another dialect */

static void test_a_message_within_a_known_one_is_not_found(void)
{
    start();
    put_wire(around(one_of(1), MAVLINK_MSG_ID_ENCAPSULATED_DATA,
                    MAVLINK_MSG_ID_ENCAPSULATED_DATA_CRC));
    TEST_ASSERT_EQUAL_UINT(1, found_count);
    TEST_ASSERT_EQUAL_UINT32(MAVLINK_MSG_ID_ENCAPSULATED_DATA, found[0].id);
}

static void test_a_message_within_an_unknown_one_is_not_found(void)
{
    start();
    for (int i = 0; i < 3; i++)
        put_wire(around(one_of(1), UNKNOWN_ID, 99));
    put_wire(one_of(0));
    TEST_ASSERT_EQUAL_UINT(1, found_count);
    assert_found(0, one_of(0));
    put_wire(around(one_of(1), UNKNOWN_ID, 99));
    wait(RECEIVER_PATIENCE_MS + 1);
    TEST_ASSERT_EQUAL_UINT(1, found_count);
    TEST_ASSERT_EQUAL_UINT(0, receiver.length);
}

static void test_the_longest_unknown_message_is_passed_over(void)
{
    wire_t inner = one_of(1);
    inner.length = 255;
    wire_t outer = around(inner, UNKNOWN_ID, 99);
    outer.bytes[2] = MAVLINK_IFLAG_SIGNED;
    outer.length += MAVLINK_SIGNATURE_BLOCK_LEN;
    TEST_ASSERT_EQUAL_UINT(RECEIVER_CAPACITY - 1, outer.length);
    start();
    put_wire(outer);
    put_wire(one_of(0));
    TEST_ASSERT_EQUAL_UINT(1, found_count);
    assert_found(0, one_of(0));
}

/* Whose length is wrong, so that good messages are within it.  One in a hundred
 * of such false ends lies before a byte that looks like a start. */
static void test_a_damaged_unknown_message_hides_no_other(void)
{
    int hidden = 0;
    for (int flip = 1; flip < 256; flip++) {
        wire_t damaged = around(one_of(2), UNKNOWN_ID, 99);
        damaged.bytes[1] ^= (uint8_t)flip;
        start();
        put_wire(damaged);
        put_wire(one_of(0));
        put_wire(one_of(3));
        wait(RECEIVER_PATIENCE_MS + 1);
        hidden += found_count < 2;
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT(4, hidden);
}

static void test_messages_of_version_1_are_read_too(void)
{
    const mavlink_param_set_t set = {.param_value = 7,
                                     .target_system = DOCK_ID_SYSTEM,
                                     .target_component = DOCK_ID_COMPONENT,
                                     .param_id = "LED_LIMIT",
                                     .param_type = MAV_PARAM_TYPE_REAL32};
    mavlink_message_t message;
    mavlink_get_channel_status(MAVLINK_COMM_0)->flags |=
        MAVLINK_STATUS_FLAG_OUT_MAVLINK1;
    mavlink_msg_param_set_encode_chan(255, 190, MAVLINK_COMM_0, &message, &set);
    mavlink_get_channel_status(MAVLINK_COMM_0)->flags = 0;
    const wire_t wire = wire_of(&message);
    TEST_ASSERT_EQUAL_UINT8(MAVLINK_STX_MAVLINK1, wire.bytes[0]);
    for (size_t cut = 0; cut <= wire.length; cut++) {
        start();
        put(wire.bytes, cut);
        put(wire.bytes + cut, wire.length - cut);
        put_wire(one_of(0));
        TEST_ASSERT_EQUAL_UINT(2, found_count);
        TEST_ASSERT_EQUAL_UINT32(MAVLINK_MSG_ID_PARAM_SET, found[0].id);
        TEST_ASSERT_EQUAL_UINT8(255, found[0].system);
        TEST_ASSERT_EQUAL_MEMORY(&set, found[0].payload,
                                 MAVLINK_MSG_ID_PARAM_SET_LEN);
        assert_found(1, one_of(0));
    }
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
    RUN_TEST(test_a_message_within_a_known_one_is_not_found);
    RUN_TEST(test_a_message_within_an_unknown_one_is_not_found);
    RUN_TEST(test_the_longest_unknown_message_is_passed_over);
    RUN_TEST(test_a_damaged_unknown_message_hides_no_other);
    RUN_TEST(test_messages_of_version_1_are_read_too);
    RUN_TEST(test_flags_that_nobody_knows_make_it_no_message);
    RUN_TEST(test_a_half_message_is_given_up_by_the_clock);
    RUN_TEST(test_the_clock_may_wrap_between_two_halves);
}

SUITE(run_tests)
