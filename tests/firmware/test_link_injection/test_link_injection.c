/* Frames that the host injects over the link. */
#include <string.h>

#include "fixture.h"
#include "golden.h"
#include "link_fixture.h"
#include "suite.h"

enum { PACKET = 253, MOST_BYTES = 60000 };

static frame_t frame_of(const golden_frame_t *golden)
{
    return (frame_t){golden_pixels + golden->frame_at,
                     golden->frame_bytes,
                     golden->width,
                     golden->height,
                     golden->format,
                     0};
}

static void test_injected_golden_frames_give_the_golden_colour(void)
{
    int injected = 0;
    for (size_t i = 0; i < golden_frame_count; i++) {
        const golden_frame_t *golden = &golden_frames[i];
        const frame_t frame = frame_of(golden);
        dock_settings_t settings = dock_default_settings();
        settings.mapping = golden->mapping;
        if (frame.length > MOST_BYTES)
            continue;
        link_start_with(&settings, (uint32_t)frame.length);
        tell_frame(&frame);
        hear();
        TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_DOCK_STATUS));
        mavlink_dock_status_t status;
        mavlink_msg_dock_status_decode(heard(MAVLINK_MSG_ID_DOCK_STATUS, 0),
                                       &status);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, status.frames, golden->name);
        TEST_ASSERT_EQUAL_UINT16(golden->marker_hue, status.marker_hue);
        TEST_ASSERT_EQUAL_UINT16(golden->marker_hue, status.decided_hue);
        for (int k = 0; k < 3; k++)
            TEST_ASSERT_EQUAL_UINT16(golden->duties[k], status.duty[k]);
        TEST_ASSERT_EQUAL_UINT16(
            golden->background.meaningful ? golden->background.hue : UINT16_MAX,
            status.background_hue);
        TEST_ASSERT_EQUAL_UINT8(golden->background.confidence,
                                status.confidence);
        TEST_ASSERT_EQUAL_UINT8(golden->background_rgb.red,
                                status.background_rgb[0]);
        TEST_ASSERT_EQUAL_UINT8(golden->background_rgb.blue,
                                status.background_rgb[2]);
        TEST_ASSERT_EQUAL_UINT32(0, status.link_faults);
        injected++;
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT(8, injected);
}

static void test_the_handshake_is_echoed_once(void)
{
    mavlink_data_transmission_handshake_t h;
    const frame_t frame = frame_of(&golden_frames[0]);
    link_start();
    tell(wire_handshake(&frame));
    hear();
    mavlink_msg_data_transmission_handshake_decode(
        heard(MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE, 0), &h);
    TEST_ASSERT_EQUAL_UINT32(QQVGA_BYTES, h.size);
    TEST_ASSERT_EQUAL_UINT16(160, h.width);
    assert_silent();
}

/* Sends the frame's packets in the order given, and counts decisions. */
static uint32_t decided_after(const uint16_t *order, size_t n)
{
    const frame_t frame = frame_of(&golden_frames[0]);
    link_start();
    tell(wire_handshake(&frame));
    for (size_t i = 0; i < n; i++)
        tell(wire_packet(&frame, order[i]));
    return dock.decision.frames;
}

static size_t in_order(uint16_t order[200])
{
    const frame_t frame = frame_of(&golden_frames[0]);
    for (uint16_t i = 0; i < packets_in(&frame); i++)
        order[i] = i;
    return packets_in(&frame);
}

static void test_a_lost_packet_costs_the_frame_and_says_so(void)
{
    uint16_t order[200];
    const size_t n = in_order(order);
    memmove(order + 7, order + 8, (n - 8) * sizeof order[0]);
    TEST_ASSERT_EQUAL_UINT32(0, decided_after(order, n - 1));
    assert_text(MAV_SEVERITY_WARNING, "injected frame dropped: lost packet 7");
    TEST_ASSERT_EQUAL_UINT32(1, dock.link.faults);
    const frame_t frame = frame_of(&golden_frames[0]);
    tell_frame(&frame);
    TEST_ASSERT_EQUAL_UINT32(1, dock.decision.frames);
    TEST_ASSERT_EQUAL_UINT16(golden_frames[0].marker_hue,
                             dock.decision.steady.shown);
}

static void test_packets_in_another_order_cost_the_frame(void)
{
    uint16_t order[200];
    const size_t n = in_order(order);
    order[100] = 101;
    order[101] = 100;
    TEST_ASSERT_EQUAL_UINT32(0, decided_after(order, n));
    assert_text(MAV_SEVERITY_WARNING,
                "injected frame dropped: lost packet 100");
}

static void test_duplicated_packets_cost_nothing(void)
{
    uint16_t order[400];
    for (uint16_t i = 0; i < 304; i++)
        order[i] = i / 2;
    TEST_ASSERT_EQUAL_UINT32(1, decided_after(order, 304));
    TEST_ASSERT_EQUAL_UINT16(golden_frames[0].marker_hue,
                             dock.decision.steady.shown);
    TEST_ASSERT_EQUAL_UINT32(0, dock.link.faults);
}

static void test_packets_without_a_handshake_are_ignored(void)
{
    const frame_t frame = frame_of(&golden_frames[0]);
    link_start();
    for (uint16_t i = 0; i < packets_in(&frame); i++)
        tell(wire_packet(&frame, i));
    TEST_ASSERT_EQUAL_UINT32(0, dock.decision.frames);
    assert_silent();
}

/* The tail of one frame and the handshake of the next one are lost. */
static void test_two_frames_are_never_mixed(void)
{
    const canvas_t one =
        canvas_of(FRAME_RGB565, 160, 120, (colour_t){0, 0, 31});
    const canvas_t two =
        canvas_of(FRAME_RGB565, 160, 120, (colour_t){0, 63, 0});
    link_start();
    tell(wire_handshake(&one.frame));
    for (uint16_t i = 0; i < 76; i++)
        tell(wire_packet(&one.frame, i));
    for (uint16_t i = 0; i < packets_in(&two.frame); i++)
        tell(wire_packet(&two.frame, i));
    TEST_ASSERT_EQUAL_UINT32(0, dock.decision.frames);
}

static void assert_injection_refused(frame_t frame, const char *text)
{
    const uint32_t before = dock.link.faults;
    tell_frame(&frame);
    assert_text(MAV_SEVERITY_WARNING, text);
    TEST_ASSERT_EQUAL_UINT32(before + 1, dock.link.faults);
    TEST_ASSERT_EQUAL_UINT32(0, dock.decision.frames);
}

static void test_announcements_of_a_wrong_size_are_refused_and_counted(void)
{
    static const uint8_t pixels[QQVGA_BYTES + 2];
    frame_t frame = {pixels, QQVGA_BYTES, 160, 120, FRAME_RGB565, 0};
    link_start();
    frame.width = 161;
    assert_injection_refused(frame,
                             "injection refused: length does not fit the size");
    frame.width = 0;
    assert_injection_refused(frame,
                             "injection refused: length does not fit the size");
    frame.width = 160;
    frame.length = QQVGA_BYTES - 2;
    assert_injection_refused(frame,
                             "injection refused: length does not fit the size");
    frame.length = QQVGA_BYTES + 2; /* more than the buffer */
    assert_injection_refused(frame, "injection refused: size or format");
    TEST_ASSERT_EQUAL_UINT32(4, status_now().link_faults);
}

static void test_handshakes_that_contradict_themselves_are_refused(void)
{
    const frame_t frame = frame_of(&golden_frames[0]);
    for (int kind = 0; kind < 3; kind++) {
        mavlink_message_t message;
        mavlink_data_transmission_handshake_t h = {
            .size = QQVGA_BYTES,
            .width = 160,
            .height = 120,
            .packets = 152,
            .type = MAVLINK_DATA_STREAM_IMG_RAW8U,
            .payload = PACKET};
        h.packets = (uint16_t)(h.packets + (kind == 0));
        h.payload = (uint8_t)(h.payload - (kind == 1));
        h.size = kind == 2 ? UINT32_MAX : h.size;
        link_start();
        mavlink_msg_data_transmission_handshake_encode(255, 190, &message, &h);
        tell(wire_of(&message));
        tell(wire_packet(&frame, 0));
        assert_text(MAV_SEVERITY_WARNING, "injection refused: size or format");
        TEST_ASSERT_EQUAL_INT(INJECTION_OFF, dock.link.injection.state);
    }
}

/* With its camera broken a dock is given no frame that could tell the time. */
static void test_a_silent_host_s_injection_ends_without_another_frame(void)
{
    const frame_t frame = frame_of(&golden_frames[0]);
    link_start();
    tell_frame(&frame);
    clock_ms += 3000;
    hear();
    tell(wire_command(MAV_CMD_DOCK_SNAPSHOT, 0, 0, 0, 0));
    assert_ack(MAV_CMD_DOCK_SNAPSHOT, MAV_RESULT_TEMPORARILY_REJECTED);
    clock_ms += 1;
    hear();
    tell(wire_command(MAV_CMD_DOCK_SNAPSHOT, 0, 0, 0, 0));
    assert_ack(MAV_CMD_DOCK_SNAPSHOT, MAV_RESULT_ACCEPTED);
}

static void run_tests(void)
{
    RUN_TEST(test_injected_golden_frames_give_the_golden_colour);
    RUN_TEST(test_the_handshake_is_echoed_once);
    RUN_TEST(test_a_lost_packet_costs_the_frame_and_says_so);
    RUN_TEST(test_packets_in_another_order_cost_the_frame);
    RUN_TEST(test_duplicated_packets_cost_nothing);
    RUN_TEST(test_packets_without_a_handshake_are_ignored);
    RUN_TEST(test_two_frames_are_never_mixed);
    RUN_TEST(test_announcements_of_a_wrong_size_are_refused_and_counted);
    RUN_TEST(test_handshakes_that_contradict_themselves_are_refused);
    RUN_TEST(test_a_silent_host_s_injection_ends_without_another_frame);
}

SUITE(run_tests)
