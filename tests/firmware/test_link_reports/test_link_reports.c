/* What the dock says by the clock or when asked, in buffers of any size. */
#include <string.h>

#include "fixture.h"
#include "link_fixture.h"
#include "suite.h"

static void start_at_rate(uint8_t hertz)
{
    dock_settings_t settings = dock_default_settings();
    settings.report_hz = hertz;
    link_start_with(&settings, QQVGA_BYTES);
}

/* Listens every millisecond and returns how many of those messages came. */
static size_t count_over(uint32_t ms, uint32_t id)
{
    size_t count = 0;
    for (uint32_t i = 0; i < ms; i++) {
        clock_ms++;
        hear();
        count += heard_count(id);
    }
    return count;
}

static void test_it_starts_with_a_heartbeat_a_text_and_a_status(void)
{
    mavlink_statustext_t text;
    link_start();
    TEST_ASSERT_EQUAL_UINT(3, heard_in_all());
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_HEARTBEAT));
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_DOCK_STATUS));
    mavlink_msg_statustext_decode(heard(MAVLINK_MSG_ID_STATUSTEXT, 0), &text);
    TEST_ASSERT_EQUAL_STRING("Chromadock 50 abcdef01 started, reset reason 1",
                             text.text);
}

static void test_the_heartbeat_is_what_ground_stations_expect(void)
{
    mavlink_heartbeat_t heartbeat;
    link_start();
    mavlink_msg_heartbeat_decode(heard(MAVLINK_MSG_ID_HEARTBEAT, 0),
                                 &heartbeat);
    TEST_ASSERT_EQUAL_UINT8(MAV_TYPE_GENERIC, heartbeat.type);
    TEST_ASSERT_EQUAL_UINT8(MAV_AUTOPILOT_GENERIC, heartbeat.autopilot);
    TEST_ASSERT_EQUAL_UINT8(MAV_STATE_ACTIVE, heartbeat.system_status);
    TEST_ASSERT_EQUAL_UINT8(3, heartbeat.mavlink_version);
    TEST_ASSERT_EQUAL_UINT8(50, heard(MAVLINK_MSG_ID_HEARTBEAT, 0)->sysid);
    TEST_ASSERT_EQUAL_UINT8(1, heard(MAVLINK_MSG_ID_HEARTBEAT, 0)->compid);
}

static void test_a_fault_shows_in_the_heartbeat(void)
{
    mavlink_heartbeat_t heartbeat;
    link_start();
    dock_frame(&dock, NULL, 0);
    clock_ms = 1000;
    hear();
    mavlink_msg_heartbeat_decode(heard(MAVLINK_MSG_ID_HEARTBEAT, 0),
                                 &heartbeat);
    TEST_ASSERT_EQUAL_UINT8(MAV_STATE_CRITICAL, heartbeat.system_status);
}

static void test_a_heartbeat_every_second(void)
{
    start_at_rate(0);
    TEST_ASSERT_EQUAL_UINT(0, count_over(999, MAVLINK_MSG_ID_HEARTBEAT));
    TEST_ASSERT_EQUAL_UINT(1, count_over(1, MAVLINK_MSG_ID_HEARTBEAT));
    TEST_ASSERT_EQUAL_UINT(10, count_over(10000, MAVLINK_MSG_ID_HEARTBEAT));
}

static void test_heartbeat_and_status_go_on_when_the_clock_wraps(void)
{
    start_at_rate(5);
    clock_ms = UINT32_MAX - 5500;
    hear();
    TEST_ASSERT_EQUAL_UINT(10, count_over(10000, MAVLINK_MSG_ID_HEARTBEAT));
    clock_ms = UINT32_MAX - 1100;
    hear();
    TEST_ASSERT_EQUAL_UINT(50, count_over(10000, MAVLINK_MSG_ID_DOCK_STATUS));
}

static void test_the_rate_of_the_status_is_that_of_the_settings(void)
{
    start_at_rate(0);
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_DOCK_STATUS));
    TEST_ASSERT_EQUAL_UINT(0, count_over(5000, MAVLINK_MSG_ID_DOCK_STATUS));
    start_at_rate(1);
    TEST_ASSERT_EQUAL_UINT(5, count_over(5000, MAVLINK_MSG_ID_DOCK_STATUS));
    start_at_rate(30); /* 33 ms apart */
    TEST_ASSERT_EQUAL_UINT(30, count_over(1000, MAVLINK_MSG_ID_DOCK_STATUS));
    tell(wire_parameter_set("REPORT_HZ", 2));
    TEST_ASSERT_EQUAL_UINT(6, count_over(3000, MAVLINK_MSG_ID_DOCK_STATUS));
}

static void test_a_silent_dock_still_answers_with_a_status(void)
{
    start_at_rate(0);
    tell(wire_command(MAV_CMD_REQUEST_MESSAGE, MAVLINK_MSG_ID_DOCK_STATUS, 0, 0,
                      0));
    assert_ack(MAV_CMD_REQUEST_MESSAGE, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_DOCK_STATUS));
    assert_silent();
}

static void test_the_status_tells_what_the_board_said(void)
{
    link_start();
    clock_ms = 123456;
    const mavlink_dock_status_t status = status_now();
    TEST_ASSERT_EQUAL_HEX64(METHOD_DIGEST, status.method_digest);
    TEST_ASSERT_EQUAL_UINT32(123456, status.time_boot_ms);
    TEST_ASSERT_EQUAL_UINT16(300, status.exposure);
    TEST_ASSERT_EQUAL_UINT8(7, status.gain);
    TEST_ASSERT_EQUAL_HEX16(0x26, status.sensor);
    TEST_ASSERT_EQUAL_UINT8(DOCK_LOCK_PROVEN, status.lock);
    TEST_ASSERT_EQUAL_UINT8(1, status.reset_reason);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, status.background_hue);
    TEST_ASSERT_EQUAL_UINT16(0, status.frame_rate_dhz);
    TEST_ASSERT_EQUAL_UINT16(0, status.duty[0]); /* dark */
    TEST_ASSERT_EQUAL_UINT16(0, status.faults);
}

static void test_an_unlocked_camera_is_a_fault_unless_it_is_asked_for(void)
{
    link_start();
    dock_set_camera(&dock, &(dock_camera_t){0, 0, false, false, 0});
    TEST_ASSERT_EQUAL_UINT16(DOCK_FAULT_UNLOCKED, status_now().faults);
    tell(wire_parameter_set("CAM_LOCK", 0));
    TEST_ASSERT_EQUAL_UINT16(0, status_now().faults);
}

static uint16_t rate_at(uint32_t period_ms)
{
    const canvas_t canvas = canvas_new(FRAME_RGB888, 1, 1);
    link_start();
    for (uint32_t i = 0; i < 60; i++)
        dock_frame(&dock, &canvas.frame, UINT32_MAX - 5000 + i * period_ms);
    canvas_free_all();
    clock_ms = UINT32_MAX - 5000 + 59 * period_ms;
    return status_now().frame_rate_dhz;
}

static void test_the_frame_rate_is_right_from_fast_to_slow(void)
{
    TEST_ASSERT_EQUAL_UINT16(303, rate_at(33));
    TEST_ASSERT_EQUAL_UINT16(100, rate_at(100));
    TEST_ASSERT_EQUAL_UINT16(10, rate_at(1000));
    TEST_ASSERT_EQUAL_UINT16(1, rate_at(10000));
    TEST_ASSERT_EQUAL_UINT16(10000, rate_at(0));
}

static void assert_version(uint16_t command, float p1)
{
    mavlink_autopilot_version_t version;
    const uint64_t digest = METHOD_DIGEST;
    link_start();
    tell(wire_command(command, p1, 0, 0, 0));
    assert_ack(command, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_AUTOPILOT_VERSION));
    mavlink_msg_autopilot_version_decode(
        heard(MAVLINK_MSG_ID_AUTOPILOT_VERSION, 0), &version);
    TEST_ASSERT_EQUAL_MEMORY("abcdef01", version.flight_custom_version, 8);
    TEST_ASSERT_EQUAL_MEMORY(&digest, version.middleware_custom_version, 8);
    TEST_ASSERT_EQUAL_HEX64(MAV_PROTOCOL_CAPABILITY_MAVLINK2 |
                                MAV_PROTOCOL_CAPABILITY_COMMAND_INT |
                                MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST,
                            version.capabilities);
    assert_silent();
}

static void test_the_version_has_the_commit_and_the_digest(void)
{
    assert_version(MAV_CMD_REQUEST_MESSAGE, MAVLINK_MSG_ID_AUTOPILOT_VERSION);
    assert_version(MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1);
}

/* All that can wait to be sent: an answer, texts, a version, parameters. */
static void ask_for_all(void)
{
    link_start();
    tell(wire_parameter_list());
    tell(wire_parameter_set("LED_LIMIT", 300));
    tell(wire_parameter_set("NONE", 1));
    tell(wire_command(MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1, 0, 0, 0));
    tell(wire_command(31999, 0, 0, 0, 0));
}

static void assert_all(void)
{
    TEST_ASSERT_EQUAL_UINT(2, heard_count(MAVLINK_MSG_ID_COMMAND_ACK));
    TEST_ASSERT_EQUAL_UINT(2, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_AUTOPILOT_VERSION));
    TEST_ASSERT_EQUAL_UINT(PARAMETER_COUNT,
                           heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
}

static void test_no_buffer_splits_a_message_or_loses_one(void)
{
    for (size_t capacity = 80; capacity < 400; capacity++) {
        ask_for_all();
        const size_t before = heard_in_all();
        while (hear_once(capacity) > 0)
            continue;
        TEST_ASSERT_EQUAL_UINT(before + 5 + PARAMETER_COUNT, heard_in_all());
        /* Less the text that link_start heard. */
        TEST_ASSERT_EQUAL_UINT(3, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    }
    ask_for_all();
    hear();
    assert_all();
}

static void test_buffers_of_changing_size_lose_nothing(void)
{
    uint32_t state = 3;
    for (int round = 0; round < 50; round++) {
        ask_for_all();
        const size_t before = heard_in_all();
        for (int i = 0; i < 400; i++)
            hear_once(noise(&state) % 130);
        TEST_ASSERT_EQUAL_UINT(before + 5 + PARAMETER_COUNT, heard_in_all());
    }
}

static void test_a_buffer_too_small_for_anything_stays_empty(void)
{
    ask_for_all();
    for (size_t capacity = 0; capacity < 13; capacity++)
        TEST_ASSERT_EQUAL_UINT(0, hear_once(capacity));
    hear();
    assert_all();
}

static void test_a_camera_that_died_has_no_rate_and_no_confidence(void)
{
    const canvas_t canvas =
        canvas_of(FRAME_RGB888, 4, 3, (colour_t){0, 0, 200});
    link_start();
    for (clock_ms = 0; clock_ms < 5000; clock_ms += 100)
        dock_frame(&dock, &canvas.frame, clock_ms);
    clock_ms = 4900 + 14999;
    mavlink_dock_status_t status = status_now();
    TEST_ASSERT_EQUAL_UINT16(100, status.frame_rate_dhz);
    TEST_ASSERT_EQUAL_UINT8(255, status.confidence);

    clock_ms = 4900 + 15000;
    status = status_now();
    TEST_ASSERT_EQUAL_UINT16(0, status.frame_rate_dhz);
    TEST_ASSERT_EQUAL_UINT8(0, status.confidence);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, status.background_hue);
    TEST_ASSERT_EQUAL_UINT16(0, status.marker_hue); /* it is shown still */
}

static void test_own_light_is_a_fault_but_no_critical_one(void)
{
    link_start();
    dock.look.clear = false;
    TEST_ASSERT_EQUAL_UINT16(DOCK_FAULT_OWN_LIGHT, status_now().faults);
    hear();
    clock_ms += 1000;
    hear();
    mavlink_heartbeat_t heartbeat;
    mavlink_msg_heartbeat_decode(heard(MAVLINK_MSG_ID_HEARTBEAT, 0),
                                 &heartbeat);
    TEST_ASSERT_EQUAL_UINT8(MAV_STATE_ACTIVE, heartbeat.system_status);
}

static void run_tests(void)
{
    RUN_TEST(test_a_camera_that_died_has_no_rate_and_no_confidence);
    RUN_TEST(test_own_light_is_a_fault_but_no_critical_one);

    RUN_TEST(test_it_starts_with_a_heartbeat_a_text_and_a_status);
    RUN_TEST(test_the_heartbeat_is_what_ground_stations_expect);
    RUN_TEST(test_a_fault_shows_in_the_heartbeat);
    RUN_TEST(test_a_heartbeat_every_second);
    RUN_TEST(test_heartbeat_and_status_go_on_when_the_clock_wraps);
    RUN_TEST(test_the_rate_of_the_status_is_that_of_the_settings);
    RUN_TEST(test_a_silent_dock_still_answers_with_a_status);
    RUN_TEST(test_the_status_tells_what_the_board_said);
    RUN_TEST(test_an_unlocked_camera_is_a_fault_unless_it_is_asked_for);
    RUN_TEST(test_the_frame_rate_is_right_from_fast_to_slow);
    RUN_TEST(test_the_version_has_the_commit_and_the_digest);
    RUN_TEST(test_no_buffer_splits_a_message_or_loses_one);
    RUN_TEST(test_buffers_of_changing_size_lose_nothing);
    RUN_TEST(test_a_buffer_too_small_for_anything_stays_empty);
}

SUITE(run_tests)
