/* What the link must not be moved by, and how it tells of faults. */
#include <string.h>

#include "fixture.h"
#include "link_fixture.h"
#include "suite.h"

static const colour_t blue_water = {0, 0, 200};
static const colour_t green_water = {0, 200, 0};

static canvas_t water(colour_t colour)
{
    return canvas_of(FRAME_RGB888, 80, 60, colour);
}

/* One of each message that could change something. */
static void tell_all(void)
{
    tell(wire_parameter_list());
    tell(wire_parameter_read("LED_HUE", -1));
    tell(wire_parameter_read("", 99));
    tell(wire_parameter_set("LED_LIMIT", 7));
    tell(wire_parameter_set("LED_LIMIT", 700));
    tell(wire_parameter_set("NONE", 7));
    tell(wire_command(MAV_CMD_DOCK_LED, DOCK_LED_RAW, 255, 255, 255));
    tell(wire_command(MAV_CMD_DOCK_SNAPSHOT, 0, 0, 0, 0));
    tell(wire_command(MAV_CMD_PREFLIGHT_STORAGE, 1, 0, 0, 0));
    tell(wire_command(MAV_CMD_PREFLIGHT_STORAGE, 9, 0, 0, 0));
    tell(wire_command(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1, 0, 0, 0));
    tell(wire_command(65000, 0, 0, 0, 0));
}

/* The receiver's own buffer apart, the dock is the same to the last byte. */
static void assert_unmoved(const dock_t *before)
{
    dock_t after = dock;
    after.link.receiver = before->link.receiver;
    TEST_ASSERT_EQUAL_MEMORY(before, &after, sizeof after);
    assert_silent();
}

static void test_messages_to_others_change_nothing_and_have_no_answer(void)
{
    static const uint8_t others[][2] = {{1, 1},    {51, 1}, {255, 1}, {50, 2},
                                        {50, 191}, {0, 2},  {1, 0}};
    static dock_t before;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        link_start();
        before = dock;
        host.target_system = others[i][0];
        host.target_component = others[i][1];
        tell_all();
        assert_unmoved(&before);
    }
}

static void test_messages_to_all_components_of_it_are_for_the_dock(void)
{
    for (uint8_t component = 0; component < 2; component++) {
        link_start();
        host.target_component = component;
        tell(wire_parameter_set("LED_LIMIT", 7));
        TEST_ASSERT_EQUAL_UINT8(7, dock.settings.led.limit);
        assert_value("LED_LIMIT", 7);
    }
}

static void test_messages_that_seem_to_come_from_the_dock_are_ignored(void)
{
    static dock_t before;
    for (uint8_t component = 0; component < 3; component++) {
        const canvas_t canvas = water(green_water);
        link_start();
        before = dock;
        host.system = DOCK_ID_SYSTEM;
        host.component = component;
        tell_all();
        tell_frame(&canvas.frame);
        assert_unmoved(&before);
    }
}

/* A tunnel, a file, a log: whatever a message carries is not for the dock. */
static void test_a_command_carried_by_another_message_is_not_obeyed(void)
{
    mavlink_message_t messages[3];
    mavlink_tunnel_t tunnel = {.payload_length = 100};
    mavlink_file_transfer_protocol_t file = {.target_system = 1};
    mavlink_log_data_t log = {.count = 90};
    link_start();
    const wire_t inner =
        wire_command(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1, 0, 0, 0);
    memcpy(tunnel.payload, inner.bytes, inner.length);
    memcpy(file.payload + 12, inner.bytes, inner.length);
    memcpy(log.data + 9, inner.bytes, inner.length);
    mavlink_msg_tunnel_encode(1, 1, &messages[0], &tunnel);
    mavlink_msg_file_transfer_protocol_encode(1, 1, &messages[1], &file);
    mavlink_msg_log_data_encode(1, 1, &messages[2], &log);
    for (size_t i = 0; i < 3; i++) {
        tell(wire_of(&messages[i]));
        assert_silent();
        TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
        TEST_ASSERT_EQUAL_UINT(0, dock.link.receiver.length);
    }
    TEST_ASSERT_EQUAL_UINT32(0, status_now().link_faults);
}

/* As where the host's own bytes come back on a wire that is joined. */
static void test_the_docks_own_words_coming_back_change_nothing(void)
{
    static dock_t before;
    uint8_t words[4000];
    link_start();
    tell(wire_parameter_list());
    clock_ms = 5000;
    const size_t n = dock_transmit(&dock, words, sizeof words, clock_ms);
    TEST_ASSERT_GREATER_THAN_UINT(500, n);
    before = dock;
    tell_bytes(words, n);
    before.link.receiver = dock.link.receiver;
    TEST_ASSERT_EQUAL_MEMORY(&before, &dock, sizeof dock);
}

static void test_no_corrupt_bit_of_any_command_changes_anything(void)
{
    static dock_t before;
    const wire_t whole[] = {(link_start(), wire_parameter_set("LED_LIMIT", 7)),
                            wire_command(MAV_CMD_DOCK_LED, 2, 9, 9, 9)};
    for (size_t k = 0; k < 2; k++)
        for (size_t bit = 0; bit < 8 * whole[k].length; bit++) {
            wire_t wire = whole[k];
            link_start();
            before = dock;
            wire.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
            tell(wire);
            clock_ms += 201;
            for (int i = 0; i < 50; i++)
                tell_bytes(NULL, 0);
            const uint32_t rejected = dock.link.receiver.rejected;
            TEST_ASSERT_LESS_OR_EQUAL_UINT32(1, rejected);
            assert_unmoved(&before);
        }
}

static void test_corrupt_messages_are_counted_in_the_status(void)
{
    link_start();
    wire_t wire = wire_parameter_set("LED_LIMIT", 7);
    wire.bytes[12] ^= 1;
    tell(wire);
    tell(wire);
    tell(wire_parameter_set("LED_LIMIT", 700));
    TEST_ASSERT_EQUAL_UINT32(3, status_now().link_faults);
}

static void test_a_message_is_answered_within_noise_and_driver_text(void)
{
    static const char text[] = "\r\nE (99) gpio: \xFD\xFE\x55 invalid\r\n";
    uint32_t state = 8;
    link_start();
    for (int round = 0; round < 100; round++) {
        uint8_t bytes[40];
        for (size_t i = 0; i < sizeof bytes; i++)
            bytes[i] = (uint8_t)noise(&state);
        tell_bytes(bytes, (size_t)round % sizeof bytes);
        tell_bytes(text, sizeof text - 1);
        tell(wire_parameter_set("LED_LIMIT", (float)round));
        clock_ms += 201;
        for (int i = 0; i < 20; i++)
            tell_bytes(NULL, 0);
        assert_value("LED_LIMIT", (float)round);
    }
}

static void test_a_lost_camera_is_said_once_and_so_is_its_return(void)
{
    const canvas_t canvas = water(blue_water);
    link_start();
    dock_frame(&dock, &canvas.frame, 0);
    assert_silent();
    dock_frame(&dock, NULL, 33);
    assert_text(MAV_SEVERITY_ERROR,
                "camera gives no frame: colour kept, restarting it");
    for (uint32_t i = 2; i < 1000; i++)
        dock_frame(&dock, NULL, 33 * i);
    assert_silent();
    TEST_ASSERT_EQUAL_UINT16(DOCK_FAULT_CAMERA, status_now().faults);
    TEST_ASSERT_EQUAL_UINT32(999, status_now().camera_faults);

    dock_frame(&dock, &canvas.frame, 40000);
    assert_text(MAV_SEVERITY_NOTICE, "camera is back");
    dock_frame(&dock, &canvas.frame, 40033);
    assert_silent();
    TEST_ASSERT_EQUAL_UINT16(0, status_now().faults);
}

/* A dock whose board says this of the stored settings; what it heard. */
static void start_with_settings(dock_stored_t stored)
{
    link_start();
    const dock_board_t board = {4, stored, "abcdef01", NULL, 0, 0};
    const dock_settings_t settings = dock_default_settings();
    dock_init(&dock, &settings);
    dock_set_board(&dock, &board);
    dock.link.sequence = 3; /* go on from link_start's three */
    hear();
}

static void test_lost_settings_are_told_until_they_are_saved(void)
{
    const dock_stored_t lost[] = {DOCK_STORED_LOST, DOCK_STORED_IN_PART};
    for (size_t i = 0; i < 2; i++) {
        start_with_settings(lost[i]);
        TEST_ASSERT_EQUAL_UINT(2, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
        TEST_ASSERT_TRUE(status_now().faults & DOCK_FAULT_SETTINGS);
        dock_saved(&dock, true);
        TEST_ASSERT_FALSE(status_now().faults & DOCK_FAULT_SETTINGS);
    }
}

static void test_a_second_copy_in_use_is_told_and_is_no_fault(void)
{
    start_with_settings(DOCK_STORED_RESTORED);
    TEST_ASSERT_EQUAL_UINT(2, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    TEST_ASSERT_FALSE(status_now().faults & DOCK_FAULT_SETTINGS);
    start_with_settings(DOCK_STORED_WHOLE);
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
}

/* A frame of each, the camera's at 30 a second as the board delivers them. */
static void inject_blue_then_camera_green(void)
{
    const canvas_t blue = water(blue_water);
    const canvas_t green = water(green_water);
    link_start();
    clock_ms = UINT32_MAX - 1000; /* it wraps on the way */
    tell_frame(&blue.frame);
    for (uint32_t at = 0; at <= 3000; at += 30)
        dock_frame(&dock, &green.frame, clock_ms + at);
}

static void test_camera_frames_are_passed_over_while_a_host_injects(void)
{
    inject_blue_then_camera_green();
    TEST_ASSERT_EQUAL_UINT32(1, dock.decision.frames);
    TEST_ASSERT_EQUAL_UINT16(0, dock.decision.steady.shown);
}

static void test_the_camera_is_back_three_seconds_after_the_last_packet(void)
{
    inject_blue_then_camera_green();
    const canvas_t green = water(green_water);
    dock_frame(&dock, &green.frame, clock_ms + 3001);
    TEST_ASSERT_EQUAL_UINT32(2, dock.decision.frames);
    TEST_ASSERT_EQUAL_UINT16(1024, dock.decision.decided_hue);
}

static void test_the_camera_is_back_at_once_when_the_host_says_so(void)
{
    inject_blue_then_camera_green();
    const canvas_t green = water(green_water);
    tell(wire_handshake(&(frame_t){.length = 0}));
    dock_frame(&dock, &green.frame, clock_ms + 3000);
    TEST_ASSERT_EQUAL_UINT32(2, dock.decision.frames);
}

static void test_half_an_injected_frame_is_dropped_with_the_injection(void)
{
    const canvas_t blue = water(blue_water);
    const canvas_t green = water(green_water);
    link_start();
    tell(wire_handshake(&blue.frame));
    for (uint16_t i = 0; i < 20; i++)
        tell(wire_packet(&blue.frame, i));
    dock_frame(&dock, &green.frame, 3001);
    for (uint16_t i = 20; i < packets_in(&blue.frame); i++)
        tell(wire_packet(&blue.frame, i));
    TEST_ASSERT_EQUAL_UINT32(1, dock.decision.frames);
    TEST_ASSERT_EQUAL_UINT16(1024, dock.decision.decided_hue);
}

static void run_tests(void)
{
    RUN_TEST(test_messages_to_others_change_nothing_and_have_no_answer);
    RUN_TEST(test_messages_to_all_components_of_it_are_for_the_dock);
    RUN_TEST(test_messages_that_seem_to_come_from_the_dock_are_ignored);
    RUN_TEST(test_a_command_carried_by_another_message_is_not_obeyed);
    RUN_TEST(test_the_docks_own_words_coming_back_change_nothing);
    RUN_TEST(test_no_corrupt_bit_of_any_command_changes_anything);
    RUN_TEST(test_corrupt_messages_are_counted_in_the_status);
    RUN_TEST(test_a_message_is_answered_within_noise_and_driver_text);
    RUN_TEST(test_a_lost_camera_is_said_once_and_so_is_its_return);
    RUN_TEST(test_lost_settings_are_told_until_they_are_saved);
    RUN_TEST(test_a_second_copy_in_use_is_told_and_is_no_fault);
    RUN_TEST(test_camera_frames_are_passed_over_while_a_host_injects);
    RUN_TEST(test_the_camera_is_back_three_seconds_after_the_last_packet);
    RUN_TEST(test_the_camera_is_back_at_once_when_the_host_says_so);
    RUN_TEST(test_half_an_injected_frame_is_dropped_with_the_injection);
}

SUITE(run_tests)
