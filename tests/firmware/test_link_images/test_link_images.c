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

static void test_a_second_snapshot_waits_for_the_first(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    link_start();
    snap(MAV_RESULT_ACCEPTED);
    dock_frame(&dock, &canvas.frame, 0);
    tell(wire_command(MAV_CMD_DOCK_SNAPSHOT, 0, 0, 0, 0));
    hear();
    mavlink_command_ack_t ack;
    mavlink_msg_command_ack_decode(heard(MAVLINK_MSG_ID_COMMAND_ACK, 0), &ack);
    TEST_ASSERT_EQUAL_UINT8(MAV_RESULT_TEMPORARILY_REJECTED, ack.result);
    assert_snapshot(&canvas.frame, MAVLINK_DATA_STREAM_IMG_RAW8U);
    snap(MAV_RESULT_ACCEPTED);
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
    RUN_TEST(test_a_second_snapshot_waits_for_the_first);
    RUN_TEST(test_a_frame_larger_than_the_buffer_is_not_sent);
    RUN_TEST(test_without_a_buffer_there_are_no_images);
}

SUITE(run_tests)
