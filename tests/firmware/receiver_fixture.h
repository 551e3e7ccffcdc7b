/* A receiver by itself, the messages it finds, and some that it should find. */
#ifndef RECEIVER_FIXTURE_H
#define RECEIVER_FIXTURE_H

#include "receiver.h"

#include <string.h>

#include "link_fixture.h"

enum { MOST_FOUND = 600 };

static receiver_t receiver;
static uint32_t now;
static struct {
    uint32_t id;
    uint8_t system, length, payload[255];
} found[MOST_FOUND];
static size_t found_count;

static inline int known(uint32_t id)
{
    switch (id) {
    case MAVLINK_MSG_ID_PARAM_SET:
        return MAVLINK_MSG_ID_PARAM_SET_CRC;
    case MAVLINK_MSG_ID_COMMAND_LONG:
        return MAVLINK_MSG_ID_COMMAND_LONG_CRC;
    case MAVLINK_MSG_ID_PARAM_REQUEST_LIST:
        return MAVLINK_MSG_ID_PARAM_REQUEST_LIST_CRC;
    case MAVLINK_MSG_ID_ENCAPSULATED_DATA:
        return MAVLINK_MSG_ID_ENCAPSULATED_DATA_CRC;
    default:
        return -1;
    }
}

static inline void start(void)
{
    link_start(); /* for the host's ids */
    memset(&receiver, 0, sizeof receiver);
    found_count = 0;
    now = 1000;
}

/* As the dock does: as many as fit, then all messages, then the rest. */
static inline void put(const void *bytes, size_t n)
{
    const uint8_t *from = bytes;
    received_t message;
    do {
        const size_t taken = receiver_put(&receiver, from, n, now);
        TEST_ASSERT_TRUE_MESSAGE(taken > 0 || n == 0, "stuck");
        n -= taken;
        if (n > 0)
            from += taken;
        while (receiver_next(&receiver, known, &message)) {
            TEST_ASSERT_TRUE(found_count < MOST_FOUND);
            found[found_count].id = message.id;
            found[found_count].system = message.system;
            found[found_count].length = message.length;
            memcpy(found[found_count].payload, message.payload, message.length);
            found_count++;
            receiver_done(&receiver);
        }
    } while (n > 0);
}

static inline void put_wire(wire_t wire)
{
    put(wire.bytes, wire.length);
}

/* Silence, and then the clock alone, as the dock calls it. */
static inline void wait(uint32_t ms)
{
    now += ms;
    for (int i = 0; i < 300; i++)
        put(NULL, 0);
}

static inline wire_t one_of(int kind)
{
    static uint8_t pixels[2 * 253];
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i * 89 + 1);
    const frame_t frame = {pixels, sizeof pixels, 1, 253, FRAME_RGB565, 0};
    switch (kind) {
    case 0:
        return wire_parameter_set("LED_LIMIT", 100);
    case 1:
        return wire_command(MAV_CMD_DOCK_LED, 2, 253, 254, 255);
    case 2:
        return wire_parameter_list();
    default:
        return wire_packet(&frame, 1);
    }
}

enum { KINDS = 4 };

static inline void assert_found(size_t n, wire_t wire)
{
    TEST_ASSERT_LESS_THAN_UINT_MESSAGE(found_count, n, "messages found");
    TEST_ASSERT_EQUAL_UINT32(wire.bytes[7], found[n].id & 0xFF);
    TEST_ASSERT_EQUAL_UINT8(wire.bytes[5], found[n].system);
    TEST_ASSERT_EQUAL_UINT8(wire.bytes[1], found[n].length);
    TEST_ASSERT_EQUAL_MEMORY(wire.bytes + 10, found[n].payload,
                             found[n].length);
}

#endif
