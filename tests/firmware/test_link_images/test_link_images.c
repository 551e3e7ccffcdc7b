/* Snapshots over the link. */
#include <string.h>

#include "fixture.h"
#include "link_fixture.h"
#include "suite.h"

enum { PACKET = 253 };

static uint8_t received[60000];

static void snap(uint8_t result)
{
    tell(wire_command(MAV_CMD_DOCK_SNAPSHOT, 0, 0, 0, 0));
    assert_ack(MAV_CMD_DOCK_SNAPSHOT, result);
}

/* Of what was heard: the handshake first, then each packet once in order. */
static void assert_snapshot(const frame_t *frame, uint8_t type)
{
    mavlink_data_transmission_handshake_t h;
    mavlink_encapsulated_data_t packet;
    const size_t packets = packets_in(frame);
    TEST_ASSERT_EQUAL_UINT(
        1, heard_count(MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE));
    mavlink_msg_data_transmission_handshake_decode(
        heard(MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE, 0), &h);
    TEST_ASSERT_EQUAL_UINT32(frame->length, h.size);
    TEST_ASSERT_EQUAL_UINT16(frame->width, h.width);
    TEST_ASSERT_EQUAL_UINT16(frame->height, h.height);
    TEST_ASSERT_EQUAL_UINT16(packets, h.packets);
    TEST_ASSERT_EQUAL_UINT8(PACKET, h.payload);
    TEST_ASSERT_EQUAL_UINT8(type, h.type);
    TEST_ASSERT_EQUAL_UINT(packets,
                           heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
    for (size_t i = 0; i < packets; i++) {
        mavlink_msg_encapsulated_data_decode(
            heard(MAVLINK_MSG_ID_ENCAPSULATED_DATA, i), &packet);
        TEST_ASSERT_EQUAL_UINT16(i, packet.seqnr);
        memcpy(received + PACKET * i, packet.data, PACKET);
    }
    TEST_ASSERT_EQUAL_MEMORY(frame->bytes, received, frame->length);
}

static void test_a_snapshot_is_the_next_frame_byte_for_byte(void)
{
    const canvas_t first = canvas_noise(FRAME_RGB565, 160, 120);
    const canvas_t later = canvas_new(FRAME_RGB565, 160, 120);
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
    dock_frame(&dock, &first.frame, 0);
    dock_frame(&dock, &later.frame, 33);
    hear();
    assert_snapshot(&first.frame, MAVLINK_DATA_STREAM_IMG_RAW8U);
    dock_frame(&dock, &later.frame, 66);
    assert_silent(); /* one is asked for, one is sent */
}

static void test_a_snapshot_passes_through_a_small_buffer(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB888, 41, 30);
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    dock_frame(&dock, &canvas.frame, 0);
    for (size_t i = 0; i < 400; i++)
        hear_once(i % 301);
    assert_snapshot(&canvas.frame, MAVLINK_DATA_STREAM_IMG_RAW32U);
}

static void test_faults_and_bad_frames_are_not_what_a_snapshot_waits_for(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    frame_t cut = canvas.frame;
    cut.length--;
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    dock_frame(&dock, NULL, 0);
    dock_frame(&dock, &cut, 1);
    dock_frame(&dock, &canvas.frame, 2);
    hear();
    assert_snapshot(&canvas.frame, MAVLINK_DATA_STREAM_IMG_RAW8U);
}

/* Whoever asks again has lost the answer, or the beginning of the picture. */
static void test_a_snapshot_asked_for_again_starts_anew(void)
{
    const canvas_t first = canvas_noise(FRAME_RGB565, 160, 120);
    const canvas_t second = canvas_new(FRAME_RGB565, 160, 120);
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    dock_frame(&dock, &first.frame, 0);
    for (int i = 0; i < 20; i++)
        hear_once(300);
    TEST_ASSERT_GREATER_THAN_UINT(
        10, heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
    snap(MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
    dock_frame(&dock, &second.frame, 100);
    hear();
    assert_snapshot(&second.frame, MAVLINK_DATA_STREAM_IMG_RAW8U);
    assert_silent();
}

static void test_a_wish_that_nothing_fulfils_expires(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    link_start();
    clock_ms = UINT32_MAX - 1000;
    snap(MAV_RESULT_ACCEPTED);
    clock_ms += 5000;
    assert_silent();
    clock_ms += 1;
    assert_text(MAV_SEVERITY_WARNING,
                "no snapshot: the camera gave no frame for 5 s");
    dock_frame(&dock, &canvas.frame, clock_ms);
    assert_silent();
}

static void test_an_old_wish_is_not_fulfilled_unheard(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    clock_ms = 600000;
    dock_frame(&dock, &canvas.frame, clock_ms);
    hear();
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
    tell(wire_handshake(&canvas.frame));
    hear();
    TEST_ASSERT_EQUAL_UINT(
        1, heard_count(MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE));
}

static uint8_t number_told(void)
{
    mavlink_data_transmission_handshake_t h;
    mavlink_msg_data_transmission_handshake_decode(
        heard(MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE, 0), &h);
    return h.jpg_quality;
}

static uint8_t take(const frame_t *frame)
{
    snap(MAV_RESULT_ACCEPTED);
    dock_frame(&dock, frame, 0);
    hear();
    return number_told();
}

static void again(float number, float first, float count, uint8_t result)
{
    tell(wire_command(MAV_CMD_DOCK_SNAPSHOT, number, first, count, 0));
    assert_ack(MAV_CMD_DOCK_SNAPSHOT, result);
}

static void test_packets_of_the_last_snapshot_are_sent_again(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    const canvas_t later = canvas_new(FRAME_RGB565, 160, 120);
    mavlink_encapsulated_data_t packet;
    link_start();
    const uint8_t number = take(&canvas.frame);
    dock_frame(&dock, &later.frame, 100);
    for (int round = 0; round < 2; round++) {
        again(number, 70, 3, MAV_RESULT_ACCEPTED);
        TEST_ASSERT_EQUAL_UINT(
            0, heard_count(MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE));
        TEST_ASSERT_EQUAL_UINT(3,
                               heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
        for (uint16_t i = 0; i < 3; i++) {
            mavlink_msg_encapsulated_data_decode(
                heard(MAVLINK_MSG_ID_ENCAPSULATED_DATA, i), &packet);
            TEST_ASSERT_EQUAL_UINT16(70 + i, packet.seqnr);
            TEST_ASSERT_EQUAL_MEMORY(canvas.frame.bytes + PACKET * (70 + i),
                                     packet.data, PACKET);
        }
    }
    again(number, 151, 1, MAV_RESULT_ACCEPTED);
}

static void test_packets_that_there_are_not_are_denied(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    link_start();
    again(1, 0, 1, MAV_RESULT_DENIED); /* no picture yet */
    const uint8_t number = take(&canvas.frame);
    again(number, 151, 2, MAV_RESULT_DENIED);
    again(number, 0, 0, MAV_RESULT_DENIED);
    again(number, -1, 2, MAV_RESULT_DENIED);
    again(number, 152, 1, MAV_RESULT_DENIED);
    again((float)(number + 1), 0, 1, MAV_RESULT_DENIED);
    again(number, 0, 1, MAV_RESULT_ACCEPTED);
}

/* Two pictures are never mixed. */
static void test_packets_of_a_picture_that_is_gone_are_denied(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    link_start();
    const uint8_t first = take(&canvas.frame);
    const uint8_t second = take(&canvas.frame);
    TEST_ASSERT_NOT_EQUAL(first, second);
    again(first, 0, 1, MAV_RESULT_DENIED);
    again(second, 0, 1, MAV_RESULT_ACCEPTED);
    tell(wire_handshake(&canvas.frame));
    hear();
    TEST_ASSERT_EQUAL_UINT8(0, number_told());
    again(second, 0, 1, MAV_RESULT_DENIED);
}

static void test_a_pictures_number_is_never_zero(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB888, 2, 2);
    link_start();
    for (int i = 0; i < 300; i++)
        TEST_ASSERT_EQUAL_UINT8(1 + i % 255, take(&canvas.frame));
}

static void test_a_frame_larger_than_the_buffer_is_not_sent(void)
{
    const canvas_t large = canvas_noise(FRAME_RGB565, 160, 121);
    const canvas_t exact = canvas_noise(FRAME_RGB565, 160, 120);
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    dock_frame(&dock, &large.frame, 0);
    assert_text(MAV_SEVERITY_WARNING, "no snapshot: the frame is too large");
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_ENCAPSULATED_DATA));
    dock_frame(&dock, &exact.frame, 1);
    assert_silent();
}

static void test_without_a_buffer_there_are_no_images(void)
{
    const dock_settings_t settings = dock_default_settings();
    const canvas_t canvas = canvas_noise(FRAME_RGB888, 2, 2);
    link_start_with(&settings, 0);
    snap(MAV_RESULT_UNSUPPORTED);
    dock_frame(&dock, &canvas.frame, 0);
    assert_silent();
    tell_frame(&canvas.frame);
    assert_text(MAV_SEVERITY_WARNING, "injection refused: size or format");
    TEST_ASSERT_EQUAL_UINT32(1, dock.decision.frames);
}

static void run_tests(void)
{
    RUN_TEST(test_a_snapshot_is_the_next_frame_byte_for_byte);
    RUN_TEST(test_a_snapshot_passes_through_a_small_buffer);
    RUN_TEST(test_faults_and_bad_frames_are_not_what_a_snapshot_waits_for);
    RUN_TEST(test_a_snapshot_asked_for_again_starts_anew);
    RUN_TEST(test_a_wish_that_nothing_fulfils_expires);
    RUN_TEST(test_an_old_wish_is_not_fulfilled_unheard);
    RUN_TEST(test_packets_of_the_last_snapshot_are_sent_again);
    RUN_TEST(test_packets_that_there_are_not_are_denied);
    RUN_TEST(test_packets_of_a_picture_that_is_gone_are_denied);
    RUN_TEST(test_a_pictures_number_is_never_zero);
    RUN_TEST(test_a_frame_larger_than_the_buffer_is_not_sent);
    RUN_TEST(test_without_a_buffer_there_are_no_images);
}

SUITE(run_tests)
