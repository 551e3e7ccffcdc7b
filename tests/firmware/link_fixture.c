#include "link_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_HEARD = 512, PACKET = 253 };

dock_t dock;
host_t host;
uint32_t clock_ms;

static uint8_t *buffer;
static mavlink_message_t messages[MOST_HEARD];
static size_t message_count;
static uint8_t next_sequence;
static mavlink_signing_t signing;

void link_start(void)
{
    const dock_settings_t settings = dock_default_settings();
    link_start_with(&settings, QQVGA_BYTES);
}

void link_start_with(const dock_settings_t *settings, uint32_t capacity)
{
    free(buffer);
    buffer = capacity > 0 ? malloc(capacity) : NULL;
    TEST_ASSERT_TRUE(capacity == 0 || buffer != NULL);
    host = (host_t){255, 190, DOCK_ID_SYSTEM, DOCK_ID_COMPONENT, false};
    clock_ms = 0;
    message_count = 0;
    next_sequence = 0;
    memset(&dock, 0xA5, sizeof dock);
    dock_init(&dock, settings);
    const dock_board_t board = {1,      false,    "abcdef01",
                                buffer, capacity, BOARD_UID};
    dock_set_board(&dock, &board);
    dock_set_camera(&dock, &(dock_camera_t){300, 7, true, true, 0x26});
    hear();
}

/* Channel 0 packs, channel 1 packs with a signature, channel 2 parses. */
static uint8_t channel(void)
{
    signing =
        (mavlink_signing_t){.flags = MAVLINK_SIGNING_FLAG_SIGN_OUTGOING,
                            .link_id = 3,
                            .timestamp = 1234567,
                            .secret_key = "thirty-two bytes of no secrecy."};
    mavlink_get_channel_status(MAVLINK_COMM_1)->signing = &signing;
    return host.sign ? MAVLINK_COMM_1 : MAVLINK_COMM_0;
}

wire_t wire_of(const mavlink_message_t *message)
{
    wire_t wire;
    wire.length = mavlink_msg_to_send_buffer(wire.bytes, message);
    return wire;
}

#define ENCODE(name, payload)                                                \
    mavlink_message_t message;                                               \
    mavlink_msg_##name##_encode_chan(host.system, host.component, channel(), \
                                     &message, payload);                     \
    return wire_of(&message)

wire_t wire_parameter_list(void)
{
    mavlink_param_request_list_t request = {.target_system = host.target_system,
                                            .target_component =
                                                host.target_component};
    ENCODE(param_request_list, &request);
}

/* Without a zero at its end where it is 16 letters long. */
static void put_name(char to[16], const char *name)
{
    for (int i = 0; i < 16 && name[i] != '\0'; i++)
        to[i] = name[i];
}

wire_t wire_parameter_read(const char *name, int16_t index)
{
    mavlink_param_request_read_t request = {.param_index = index,
                                            .target_system = host.target_system,
                                            .target_component =
                                                host.target_component};
    put_name(request.param_id, name);
    ENCODE(param_request_read, &request);
}

wire_t wire_parameter_set(const char *name, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return wire_parameter_bits(name, bits, MAV_PARAM_TYPE_REAL32);
}

wire_t wire_parameter_bits(const char *name, uint32_t bits, uint8_t type)
{
    mavlink_param_set_t request = {.target_system = host.target_system,
                                   .target_component = host.target_component,
                                   .param_type = type};
    memcpy(&request.param_value, &bits, sizeof bits);
    put_name(request.param_id, name);
    ENCODE(param_set, &request);
}

wire_t wire_command(uint16_t command, float p1, float p2, float p3, float p4)
{
    mavlink_command_long_t request = {.param1 = p1,
                                      .param2 = p2,
                                      .param3 = p3,
                                      .param4 = p4,
                                      .command = command,
                                      .target_system = host.target_system,
                                      .target_component =
                                          host.target_component};
    ENCODE(command_long, &request);
}

wire_t wire_command_int(uint16_t command, float p1, float p2, float p3,
                        float p4)
{
    mavlink_command_int_t request = {.param1 = p1,
                                     .param2 = p2,
                                     .param3 = p3,
                                     .param4 = p4,
                                     .command = command,
                                     .target_system = host.target_system,
                                     .target_component = host.target_component};
    ENCODE(command_int, &request);
}

uint16_t packets_in(const frame_t *frame)
{
    return (uint16_t)((frame->length + PACKET - 1) / PACKET);
}

wire_t wire_handshake(const frame_t *frame)
{
    mavlink_data_transmission_handshake_t handshake = {
        .size = (uint32_t)frame->length,
        .width = frame->width,
        .height = frame->height,
        .packets = packets_in(frame),
        .type = frame->format == FRAME_RGB565 ? MAVLINK_DATA_STREAM_IMG_RAW8U
                                              : MAVLINK_DATA_STREAM_IMG_RAW32U,
        .payload = PACKET};
    ENCODE(data_transmission_handshake, &handshake);
}

wire_t wire_packet(const frame_t *frame, uint16_t number)
{
    const size_t at = (size_t)number * PACKET;
    const size_t left = frame->length - at;
    mavlink_encapsulated_data_t packet = {.seqnr = number};
    memcpy(packet.data, frame->bytes + at, left < PACKET ? left : PACKET);
    ENCODE(encapsulated_data, &packet);
}

void tell_bytes(const void *bytes, size_t n)
{
    dock_receive(&dock, bytes, n, clock_ms);
}

void tell(wire_t wire)
{
    tell_bytes(wire.bytes, wire.length);
}

void tell_frame(const frame_t *frame)
{
    tell(wire_handshake(frame));
    for (uint16_t i = 0; i < packets_in(frame); i++)
        tell(wire_packet(frame, i));
}

static void parse(const uint8_t *bytes, size_t n)
{
    mavlink_status_t status;
    size_t of_messages = 0;
    for (size_t i = 0; i < n; i++) {
        TEST_ASSERT_TRUE_MESSAGE(message_count < MOST_HEARD, "too many");
        mavlink_message_t *message = &messages[message_count];
        const uint8_t result =
            mavlink_frame_char(MAVLINK_COMM_2, bytes[i], message, &status);
        TEST_ASSERT_NOT_EQUAL_MESSAGE(MAVLINK_FRAMING_BAD_CRC, result,
                                      "the dock's checksum");
        if (result != MAVLINK_FRAMING_OK)
            continue;
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(next_sequence++, message->seq,
                                        "sequence");
        TEST_ASSERT_EQUAL_UINT8(dock.link.system, message->sysid);
        TEST_ASSERT_EQUAL_UINT8(DOCK_ID_COMPONENT, message->compid);
        of_messages += MAVLINK_NUM_NON_PAYLOAD_BYTES + message->len;
        message_count++;
    }
    TEST_ASSERT_EQUAL_UINT_MESSAGE(n, of_messages, "stray bytes");
}

size_t hear_once(size_t capacity)
{
    /* Exactly as long, for AddressSanitizer. */
    uint8_t *bytes = capacity > 0 ? malloc(capacity) : NULL;
    const size_t n = dock_transmit(&dock, bytes, capacity, clock_ms);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(capacity, n);
    parse(bytes, n);
    free(bytes);
    return n;
}

void hear(void)
{
    message_count = 0;
    while (hear_once(2000) > 0)
        continue;
}

size_t heard_in_all(void)
{
    return message_count;
}

const mavlink_message_t *heard_at(size_t n)
{
    TEST_ASSERT_LESS_THAN_UINT_MESSAGE(message_count, n, "messages heard");
    return &messages[n];
}

size_t heard_count(uint32_t id)
{
    size_t count = 0;
    for (size_t i = 0; i < message_count; i++)
        count += messages[i].msgid == id;
    return count;
}

const mavlink_message_t *heard(uint32_t id, size_t n)
{
    for (size_t i = 0; i < message_count; i++)
        if (messages[i].msgid == id && n-- == 0)
            return &messages[i];
    TEST_FAIL_MESSAGE("the dock did not send the message");
    return NULL;
}

void assert_silent(void)
{
    hear();
    TEST_ASSERT_EQUAL_UINT_MESSAGE(heard_count(MAVLINK_MSG_ID_HEARTBEAT) +
                                       heard_count(MAVLINK_MSG_ID_DOCK_STATUS),
                                   message_count, "an answer to nothing");
}

void assert_ack(uint16_t command, uint8_t result)
{
    mavlink_command_ack_t ack;
    hear();
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, heard_count(MAVLINK_MSG_ID_COMMAND_ACK),
                                   "acknowledgements");
    mavlink_msg_command_ack_decode(heard(MAVLINK_MSG_ID_COMMAND_ACK, 0), &ack);
    TEST_ASSERT_EQUAL_UINT16(command, ack.command);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(result, ack.result, "result");
    TEST_ASSERT_EQUAL_UINT8(host.system, ack.target_system);
    TEST_ASSERT_EQUAL_UINT8(host.component, ack.target_component);
}

void assert_text(uint8_t severity, const char *expected)
{
    mavlink_statustext_t text;
    char words[sizeof text.text + 1] = {0};
    hear();
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, heard_count(MAVLINK_MSG_ID_STATUSTEXT),
                                   "texts");
    mavlink_msg_statustext_decode(heard(MAVLINK_MSG_ID_STATUSTEXT, 0), &text);
    memcpy(words, text.text, sizeof text.text);
    TEST_ASSERT_EQUAL_STRING(expected, words);
    TEST_ASSERT_EQUAL_UINT8(severity, text.severity);
}

/* The one answer about a parameter that was heard, which is of this type. */
static mavlink_param_value_t value_heard(const char *name, uint8_t type)
{
    mavlink_param_value_t answer;
    char words[sizeof answer.param_id + 1] = {0};
    hear();
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, heard_count(MAVLINK_MSG_ID_PARAM_VALUE),
                                   name);
    mavlink_msg_param_value_decode(heard(MAVLINK_MSG_ID_PARAM_VALUE, 0),
                                   &answer);
    memcpy(words, answer.param_id, sizeof answer.param_id);
    TEST_ASSERT_EQUAL_STRING(name, words);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(type, answer.param_type, name);
    return answer;
}

void assert_value(const char *name, float value)
{
    const mavlink_param_value_t answer =
        value_heard(name, MAV_PARAM_TYPE_REAL32);
    TEST_ASSERT_TRUE_MESSAGE(answer.param_value == value, name);
}

void assert_whole(const char *name, int32_t value)
{
    const mavlink_param_value_t answer =
        value_heard(name, MAV_PARAM_TYPE_INT32);
    int32_t told;
    memcpy(&told, &answer.param_value, sizeof told);
    TEST_ASSERT_EQUAL_INT32_MESSAGE(value, told, name);
}

mavlink_dock_status_t status_now(void)
{
    mavlink_dock_status_t status;
    hear();
    tell(wire_command(MAV_CMD_REQUEST_MESSAGE, MAVLINK_MSG_ID_DOCK_STATUS, 0, 0,
                      0));
    hear();
    mavlink_msg_dock_status_decode(heard(MAVLINK_MSG_ID_DOCK_STATUS, 0),
                                   &status);
    return status;
}
