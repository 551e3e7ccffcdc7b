/* Commands over the link, and what the board is asked for. */
#include <math.h>
#include <string.h>

#include "link_fixture.h"
#include "suite.h"

static void command(uint16_t number, float p1, float p2, float p3, float p4)
{
    tell(wire_command(number, p1, p2, p3, p4));
}

static void led(float mode, float p2, float p3, float p4, uint8_t result)
{
    command(MAV_CMD_DOCK_LED, mode, p2, p3, p4);
    assert_ack(MAV_CMD_DOCK_LED, result);
}

static void start_upright(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.led.common_anode = false;
    link_start_with(&settings, QQVGA_BYTES);
}

static void assert_duties(int red, int green, int blue)
{
    uint16_t duty[3];
    dock_led_duties(&dock, duty, 0);
    TEST_ASSERT_EQUAL_UINT16(red, duty[0]);
    TEST_ASSERT_EQUAL_UINT16(green, duty[1]);
    TEST_ASSERT_EQUAL_UINT16(blue, duty[2]);
}

static void test_a_mode_between_two_is_none(void)
{
    start_upright();
    led(0.5f, 0, 0, 0, MAV_RESULT_DENIED);
    led(-0.25f, 0, 0, 0, MAV_RESULT_DENIED);
    led(-0.0f, 0, 0, 0, MAV_RESULT_ACCEPTED);
}

static void test_raw_lights_one_channel_at_a_time(void)
{
    start_upright();
    led(DOCK_LED_RAW, 255, 0, 0, MAV_RESULT_ACCEPTED);
    assert_duties(4096, 0, 0);
    led(DOCK_LED_RAW, 0, 255, 0, MAV_RESULT_ACCEPTED);
    assert_duties(0, 4096, 0);
    led(DOCK_LED_RAW, 0, 0, 255, MAV_RESULT_ACCEPTED);
    assert_duties(0, 0, 4096);
    /* 4096 * n / 255, no gamma */
    led(DOCK_LED_RAW, 128, 1, 64, MAV_RESULT_ACCEPTED);
    assert_duties(2056, 16, 1028);
    TEST_ASSERT_EQUAL_UINT8(DOCK_LED_RAW, status_now().led_mode);
}

static void test_hue_lights_that_hue(void)
{
    start_upright();
    led(DOCK_LED_HUE, 120, 0, 0, MAV_RESULT_ACCEPTED);
    assert_duties(0, 4096, 0);
    led(DOCK_LED_HUE, 240, 0, 0, MAV_RESULT_ACCEPTED);
    assert_duties(0, 0, 4096);
    led(DOCK_LED_HUE, 30, 0, 0, MAV_RESULT_ACCEPTED);
    assert_duties(4096, 899, 0); /* 4096 * (128 / 255)^2.2 */
}

static void test_zero_and_a_whole_turn_are_the_same_hue(void)
{
    start_upright();
    led(DOCK_LED_HUE, 0, 0, 0, MAV_RESULT_ACCEPTED);
    assert_duties(4096, 0, 0);
    led(DOCK_LED_HUE, 120, 0, 0, MAV_RESULT_ACCEPTED);
    led(DOCK_LED_HUE, 360, 0, 0, MAV_RESULT_ACCEPTED);
    assert_duties(4096, 0, 0);
}

static void test_auto_goes_back_to_the_water(void)
{
    start_upright();
    led(DOCK_LED_RAW, 0, 255, 0, MAV_RESULT_ACCEPTED);
    led(DOCK_LED_AUTO, NAN, NAN, NAN, MAV_RESULT_ACCEPTED);
    assert_duties(0, 0, 0); /* nothing decided yet */
    TEST_ASSERT_EQUAL_UINT8(DOCK_LED_AUTO, status_now().led_mode);
}

static void test_arguments_out_of_range_leave_the_leds_as_they_are(void)
{
    static const float wrong[][4] = {
        {3, 0, 0, 0},  {-1, 0, 0, 0},  {NAN, 0, 0, 0},      {1, 361, 0, 0},
        {1, -1, 0, 0}, {1, NAN, 0, 0}, {1, INFINITY, 0, 0}, {2, 256, 0, 0},
        {2, 0, -1, 0}, {2, 0, 0, NAN}, {2, 0, 0, 1e30f},    {INFINITY, 0, 0, 0},
    };
    start_upright();
    led(DOCK_LED_RAW, 255, 0, 255, MAV_RESULT_ACCEPTED);
    for (uint32_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        led(wrong[i][0], wrong[i][1], wrong[i][2], wrong[i][3],
            MAV_RESULT_DENIED);
        assert_duties(4096, 0, 4096);
        TEST_ASSERT_EQUAL_UINT32(i + 1, dock.link.faults);
    }
}

static void test_unknown_commands_are_unsupported(void)
{
    link_start();
    command(MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0);
    assert_ack(MAV_CMD_NAV_TAKEOFF, MAV_RESULT_UNSUPPORTED);
    command(65535, 0, 0, 0, 0);
    assert_ack(65535, MAV_RESULT_UNSUPPORTED);
    command(0, 0, 0, 0, 0);
    assert_ack(0, MAV_RESULT_UNSUPPORTED);
}

static void save(void)
{
    command(MAV_CMD_PREFLIGHT_STORAGE, 1, 0, 0, 0);
}

static void assert_saved(bool written, uint8_t result)
{
    link_start();
    save();
    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_IN_PROGRESS);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_SAVE, dock_take_request(&dock));
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    hear();
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_COMMAND_ACK));

    dock_saved(&dock, written);

    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, result);
}

/* The board pauses its camera first: 0.24 to 4 s, and hosts repeat after 0.4.
 */
static void test_a_save_asked_for_again_is_the_same_save(void)
{
    link_start();
    save();
    save();
    hear();
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_SAVE, dock_take_request(&dock));
    for (int i = 0; i < 5; i++) {
        save();
        assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_IN_PROGRESS);
        TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    }
    dock_saved(&dock, true);
    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_ACCEPTED);
    assert_silent();
    save();
    hear();
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_SAVE, dock_take_request(&dock));
}

static void test_a_save_for_two_hosts_is_answered_to_both(void)
{
    mavlink_command_ack_t ack;
    link_start();
    save();
    host.system = 254;
    save();
    hear();
    dock_saved(&dock, true);
    hear();
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_COMMAND_ACK));
    mavlink_msg_command_ack_decode(heard(MAVLINK_MSG_ID_COMMAND_ACK, 0), &ack);
    TEST_ASSERT_EQUAL_UINT8(MAV_RESULT_ACCEPTED, ack.result);
    TEST_ASSERT_EQUAL_UINT8(0, ack.target_system); /* everybody */
    save();
    hear();
    dock_saved(&dock, true);
    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_ACCEPTED);
}

static void test_a_save_is_acknowledged_when_it_is_written(void)
{
    assert_saved(true, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    TEST_ASSERT_EQUAL_UINT16(0, status_now().faults);
}

static void test_a_save_that_fails_is_said_to_fail(void)
{
    assert_saved(false, MAV_RESULT_FAILED);
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    TEST_ASSERT_EQUAL_UINT16(DOCK_FAULT_STORAGE, status_now().faults);

    save();
    hear();
    dock_saved(&dock, true);
    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT16(0, status_now().faults);
}

static void test_a_save_of_the_boards_own_is_not_acknowledged(void)
{
    link_start();
    dock_saved(&dock, true);
    assert_silent();
}

static void test_defaults_come_back_on_command(void)
{
    dock_settings_t defaults = dock_default_settings();
    defaults.led.limit = 3; /* the wiring's */
    defaults.led.common_anode = true;
    link_start();
    tell(wire_parameter_set("LED_LIMIT", 3));
    tell(wire_parameter_set("LED_ANODE", 1));
    tell(wire_parameter_set("WINDOW_MS", 300));
    tell(wire_parameter_set("LED_MODE", 1));
    tell(wire_parameter_set("CAM_GAIN", 3));
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_CAMERA, dock_take_request(&dock));

    command(MAV_CMD_PREFLIGHT_STORAGE, 2, 0, 0, 0);

    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_MEMORY(&defaults, &dock.settings, sizeof defaults);
    TEST_ASSERT_EQUAL_UINT8(DOCK_LED_AUTO, dock.lamps.mode);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_CAMERA, dock_take_request(&dock));
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
}

static void test_other_arguments_of_storage_and_reboot_are_denied(void)
{
    static const float wrong[] = {0, 3, -1, 5, NAN};
    link_start();
    for (size_t i = 0; i < 5; i++) {
        command(MAV_CMD_PREFLIGHT_STORAGE, wrong[i], 0, 0, 0);
        assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_DENIED);
        command(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, wrong[i], 0, 0, 0);
        assert_ack(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, MAV_RESULT_DENIED);
        TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    }
}

static void test_a_reboot_waits_for_its_acknowledgement(void)
{
    link_start();
    command(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1, 0, 0, 0);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    hear_once(10); /* too small for it */
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    assert_ack(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_REBOOT, dock_take_request(&dock));
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
}

static void test_a_reboot_waits_for_the_save(void)
{
    link_start();
    command(MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1, 0, 0, 0);
    command(MAV_CMD_PREFLIGHT_STORAGE, 1, 0, 0, 0);
    hear();
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_SAVE, dock_take_request(&dock));
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    dock_saved(&dock, true);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    assert_ack(MAV_CMD_PREFLIGHT_STORAGE, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_REBOOT, dock_take_request(&dock));
}

static void test_answers_go_to_whoever_asked_in_that_order(void)
{
    mavlink_command_ack_t ack;
    link_start();
    for (uint8_t i = 0; i < LINK_ACKS; i++) {
        host.system = (uint8_t)(1 + i);
        host.component = (uint8_t)(100 + i);
        command((uint16_t)(60000 + i), 0, 0, 0, 0);
    }
    hear();
    TEST_ASSERT_EQUAL_UINT(LINK_ACKS, heard_count(MAVLINK_MSG_ID_COMMAND_ACK));
    for (uint8_t i = 0; i < LINK_ACKS; i++) {
        mavlink_msg_command_ack_decode(heard(MAVLINK_MSG_ID_COMMAND_ACK, i),
                                       &ack);
        TEST_ASSERT_EQUAL_UINT16(60000 + i, ack.command);
        TEST_ASSERT_EQUAL_UINT8(1 + i, ack.target_system);
        TEST_ASSERT_EQUAL_UINT8(100 + i, ack.target_component);
    }
}

static void run_tests(void)
{
    RUN_TEST(test_a_mode_between_two_is_none);
    RUN_TEST(test_raw_lights_one_channel_at_a_time);
    RUN_TEST(test_hue_lights_that_hue);
    RUN_TEST(test_zero_and_a_whole_turn_are_the_same_hue);
    RUN_TEST(test_auto_goes_back_to_the_water);
    RUN_TEST(test_arguments_out_of_range_leave_the_leds_as_they_are);
    RUN_TEST(test_unknown_commands_are_unsupported);
    RUN_TEST(test_a_save_is_acknowledged_when_it_is_written);
    RUN_TEST(test_a_save_asked_for_again_is_the_same_save);
    RUN_TEST(test_a_save_for_two_hosts_is_answered_to_both);
    RUN_TEST(test_a_save_that_fails_is_said_to_fail);
    RUN_TEST(test_a_save_of_the_boards_own_is_not_acknowledged);
    RUN_TEST(test_defaults_come_back_on_command);
    RUN_TEST(test_other_arguments_of_storage_and_reboot_are_denied);
    RUN_TEST(test_a_reboot_waits_for_its_acknowledgement);
    RUN_TEST(test_a_reboot_waits_for_the_save);
    RUN_TEST(test_answers_go_to_whoever_asked_in_that_order);
}

SUITE(run_tests)
