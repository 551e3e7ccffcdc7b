/* What the LEDs show by command, and what ends that. */
#include <string.h>

#include "link_fixture.h"
#include "suite.h"

enum { LIMIT_MS = 600000 };

static void start_upright(uint8_t led_mode)
{
    dock_settings_t settings = dock_default_settings();
    settings.led.common_anode = false;
    settings.led_mode = led_mode;
    settings.led_hue = 512; /* green */
    link_start_with(&settings, QQVGA_BYTES);
}

static void led(float mode, float p2, float p3, float p4)
{
    tell(wire_command(MAV_CMD_DOCK_LED, mode, p2, p3, p4));
    assert_ack(MAV_CMD_DOCK_LED, MAV_RESULT_ACCEPTED);
}

static void assert_duties(int red, int green, int blue)
{
    uint16_t duty[3];
    dock_led_duties(&dock, duty, clock_ms);
    TEST_ASSERT_EQUAL_UINT16(red, duty[0]);
    TEST_ASSERT_EQUAL_UINT16(green, duty[1]);
    TEST_ASSERT_EQUAL_UINT16(blue, duty[2]);
}

static void set(const char *name, float value)
{
    tell(wire_parameter_set(name, value));
    hear();
}

static void test_setting_the_mode_ends_a_test_whatever_it_was_before(void)
{
    start_upright(DOCK_LED_AUTO);
    led(DOCK_LED_RAW, 255, 255, 255);
    assert_duties(4096, 4096, 4096);
    set("LED_MODE", 0);
    assert_duties(0, 0, 0);
    start_upright(DOCK_LED_HUE);
    led(DOCK_LED_RAW, 255, 0, 0);
    set("LED_MODE", 1);
    assert_duties(0, 4096, 0);
    led(DOCK_LED_HUE, 240, 0, 0);
    set("LED_HUE", 120);
    assert_duties(0, 4096, 0);
}

static void test_going_back_to_the_defaults_ends_a_test(void)
{
    start_upright(DOCK_LED_AUTO);
    led(DOCK_LED_RAW, 0, 255, 0);
    tell(wire_command(MAV_CMD_PREFLIGHT_STORAGE, 2, 0, 0, 0));
    hear();
    TEST_ASSERT_EQUAL_UINT8(DOCK_LED_AUTO, status_now().led_mode);
}

static void test_a_refused_mode_ends_nothing(void)
{
    start_upright(DOCK_LED_AUTO);
    led(DOCK_LED_RAW, 255, 0, 0);
    set("LED_MODE", 9);
    set("LED_LIMIT", 255);
    assert_duties(4096, 0, 0);
}

/* At some time after a test began, also where the clock wraps on the way. */
static void assert_ends(uint32_t begin)
{
    start_upright(DOCK_LED_HUE);
    clock_ms = begin;
    hear();
    led(DOCK_LED_RAW, 255, 0, 0);
    for (uint32_t at = 0; at < LIMIT_MS; at += 1000) {
        clock_ms = begin + at;
        hear();
        TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
        assert_duties(4096, 0, 0);
    }
    clock_ms = begin + LIMIT_MS;
    assert_text(MAV_SEVERITY_NOTICE,
                "LED test ended after 10 minutes: LED_MODE again");
    assert_duties(0, 4096, 0);
    clock_ms += LIMIT_MS;
    assert_silent();
}

static void test_a_test_ends_after_ten_minutes_and_says_so(void)
{
    assert_ends(5000);
    assert_ends(UINT32_MAX - LIMIT_MS / 2);
}

static void test_each_command_begins_the_ten_minutes_anew(void)
{
    start_upright(DOCK_LED_AUTO);
    led(DOCK_LED_RAW, 255, 0, 0);
    clock_ms = LIMIT_MS - 1;
    led(DOCK_LED_HUE, 240, 0, 0);
    clock_ms = 2 * LIMIT_MS - 2;
    hear();
    assert_duties(0, 0, 4096);
    clock_ms++;
    hear();
    assert_duties(0, 0, 0);
}

static void test_the_markers_colour_is_a_test_only_against_the_settings(void)
{
    start_upright(DOCK_LED_AUTO);
    led(DOCK_LED_RAW, 255, 0, 0);
    led(DOCK_LED_AUTO, 0, 0, 0);
    clock_ms = LIMIT_MS;
    assert_silent();
    start_upright(DOCK_LED_HUE);
    led(DOCK_LED_AUTO, 0, 0, 0);
    assert_duties(0, 0, 0); /* nothing decided yet */
    clock_ms = LIMIT_MS;
    hear();
    assert_duties(0, 4096, 0);
}

static void run_tests(void)
{
    RUN_TEST(test_setting_the_mode_ends_a_test_whatever_it_was_before);
    RUN_TEST(test_going_back_to_the_defaults_ends_a_test);
    RUN_TEST(test_a_refused_mode_ends_nothing);
    RUN_TEST(test_a_test_ends_after_ten_minutes_and_says_so);
    RUN_TEST(test_each_command_begins_the_ten_minutes_anew);
    RUN_TEST(test_the_markers_colour_is_a_test_only_against_the_settings);
}

SUITE(run_tests)
