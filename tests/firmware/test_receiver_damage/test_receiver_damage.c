/* The receiver in a damaged stream: each damage costs what it hits and no more.
 */
#include "receiver_fixture.h"
#include "suite.h"

static void test_a_message_cut_anywhere_does_not_cost_the_next_one(void)
{
    for (int kind = 0; kind < KINDS; kind++) {
        const wire_t wire = one_of(kind);
        for (size_t cut = 0; cut < wire.length; cut++) {
            start();
            put(wire.bytes, cut);
            put_wire(one_of(0));
            wait(RECEIVER_PATIENCE_MS + 1);
            TEST_ASSERT_EQUAL_UINT(1, found_count);
            assert_found(0, one_of(0));
        }
    }
}

static void
test_a_message_without_its_beginning_does_not_cost_the_next_one(void)
{
    for (int kind = 0; kind < KINDS; kind++) {
        const wire_t wire = one_of(kind);
        for (size_t cut = 1; cut <= wire.length; cut++) {
            start();
            put(wire.bytes + cut, wire.length - cut);
            put_wire(one_of(0));
            wait(RECEIVER_PATIENCE_MS + 1);
            TEST_ASSERT_EQUAL_UINT(1, found_count);
            assert_found(0, one_of(0));
        }
    }
}

static void test_a_corrupt_byte_anywhere_costs_that_message_only(void)
{
    static const uint8_t flips[] = {0x01, 0x80, 0xFF};
    for (int kind = 0; kind < KINDS; kind++)
        for (size_t flip = 0; flip < sizeof flips; flip++)
            for (size_t at = 0; at < one_of(kind).length; at++) {
                wire_t wire = one_of(kind);
                wire.bytes[at] ^= flips[flip];
                start();
                put_wire(one_of(1));
                put_wire(wire);
                put_wire(one_of(0));
                wait(RECEIVER_PATIENCE_MS + 1);
                TEST_ASSERT_EQUAL_UINT(2, found_count);
                assert_found(0, one_of(1));
                assert_found(1, one_of(0));
            }
}

static void test_a_byte_lost_or_doubled_anywhere_costs_that_message_only(void)
{
    for (int kind = 0; kind < KINDS; kind++)
        for (size_t at = 0; at < one_of(kind).length; at++)
            for (int doubled = 0; doubled < 2; doubled++) {
                const wire_t wire = one_of(kind);
                /* Doubling the first byte, or one equal to its neighbour, may
                 * leave the message whole behind it. */
                const bool whole = doubled && at == 0;
                start();
                put(wire.bytes, at);
                if (doubled)
                    put(wire.bytes + at, 1);
                put(wire.bytes + at + !doubled, wire.length - at - !doubled);
                put_wire(one_of(0));
                wait(RECEIVER_PATIENCE_MS + 1);
                TEST_ASSERT_GREATER_OR_EQUAL_UINT(1u + whole, found_count);
                assert_found(found_count - 1, one_of(0));
            }
}

static void test_text_before_inside_and_after(void)
{
    static const char text[] = "E (1234) cam_hal: FB-OVF \xC3\xA9\r\n";
    const wire_t wire = one_of(1);
    start();
    put(text, sizeof text - 1);
    put_wire(wire);
    put(text, sizeof text - 1);
    TEST_ASSERT_EQUAL_UINT(1, found_count);
    for (size_t at = 1; at < wire.length; at++) {
        start();
        put(wire.bytes, at); /* this one is broken */
        put(text, sizeof text - 1);
        put(wire.bytes + at, wire.length - at);
        put_wire(one_of(0));
        wait(RECEIVER_PATIENCE_MS + 1);
        TEST_ASSERT_EQUAL_UINT(1, found_count);
        assert_found(0, one_of(0));
    }
}

static void test_false_starts_in_text_cost_nothing(void)
{
    static const char *const texts[] = {
        "\xFD",
        "\xFD\xFD\xFD",
        "ab\xFD"
        "cd",
        "\xFD\xFF",
        /* as long as a known message and of its id, but for the checksum */
        "\xFD\x02\x01\x01\x01\x01\x01\x15",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        start();
        put(texts[i], strlen(texts[i]));
        put_wire(one_of(2));
        wait(RECEIVER_PATIENCE_MS + 1);
        TEST_ASSERT_EQUAL_UINT(1, found_count);
        assert_found(0, one_of(2));
    }
}

static void test_a_believable_false_start_holds_the_next_message_back_only(void)
{
    /* A header of COMMAND_LONG with 255 bytes to come. */
    static const uint8_t start_of_none[] = {0xFD, 255, 0, 0, 0, 1, 1, 76, 0, 0};
    start();
    put(start_of_none, sizeof start_of_none);
    put_wire(one_of(0));
    put_wire(one_of(1));
    TEST_ASSERT_EQUAL_UINT(0, found_count);

    wait(RECEIVER_PATIENCE_MS + 1);

    TEST_ASSERT_EQUAL_UINT(2, found_count);
    assert_found(0, one_of(0));
    assert_found(1, one_of(1));
}

static void test_a_buffer_full_of_start_bytes_is_emptied(void)
{
    uint8_t starts[3 * RECEIVER_CAPACITY];
    memset(starts, 0xFD, sizeof starts);
    for (size_t n = 1; n <= sizeof starts; n += n < 300 ? 1 : 97) {
        start();
        put(starts, n);
        put_wire(one_of(0));
        wait(RECEIVER_PATIENCE_MS + 1);
        TEST_ASSERT_EQUAL_UINT(1, found_count);
    }
    TEST_ASSERT_EQUAL_UINT(0, receiver.length);
}

static void test_wrong_checksums_are_counted(void)
{
    wire_t wire = one_of(1);
    start();
    wire.bytes[15] ^= 1;
    put_wire(wire);
    put_wire(wire);
    put_wire(one_of(1));
    TEST_ASSERT_EQUAL_UINT32(2, receiver.rejected);
    TEST_ASSERT_EQUAL_UINT(1, found_count);
}

static void run_tests(void)
{
    RUN_TEST(test_a_message_cut_anywhere_does_not_cost_the_next_one);
    RUN_TEST(test_a_message_without_its_beginning_does_not_cost_the_next_one);
    RUN_TEST(test_a_corrupt_byte_anywhere_costs_that_message_only);
    RUN_TEST(test_a_byte_lost_or_doubled_anywhere_costs_that_message_only);
    RUN_TEST(test_text_before_inside_and_after);
    RUN_TEST(test_false_starts_in_text_cost_nothing);
    RUN_TEST(test_a_believable_false_start_holds_the_next_message_back_only);
    RUN_TEST(test_a_buffer_full_of_start_bytes_is_emptied);
    RUN_TEST(test_wrong_checksums_are_counted);
}

SUITE(run_tests)
