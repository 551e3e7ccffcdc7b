/* The LEDs: dark until they may shine, then what the dock decided. */
#include "../../shell/shell.h"
#include "../suite.h"

/* Light of an LED at this pin, 0..4096, whichever way round it is wired. */
static uint32_t light(int channel)
{
    return board.duty[channel];
}

static void test_open_pins_have_no_pull(void)
{
    board_reset();

    pwm_release();

    for (const int pin : {13, 14, 15}) {
        TEST_ASSERT_EQUAL_INT(GPIO_MODE_INPUT, board.direction[pin]);
        TEST_ASSERT_EQUAL_INT(GPIO_FLOATING, board.pull[pin]);
    }
}

static void test_the_leds_have_a_group_and_timer_of_their_own(void)
{
    board_reset();

    pwm_start(true);

    TEST_ASSERT_EQUAL_INT(LEDC_HIGH_SPEED_MODE, board.timer.speed_mode);
    TEST_ASSERT_EQUAL_INT(LEDC_TIMER_1, board.timer.timer_num);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(LEDC_HIGH_SPEED_MODE,
                              board.channel[i].speed_mode);
        TEST_ASSERT_EQUAL_INT(LEDC_TIMER_1, board.channel[i].timer_sel);
        TEST_ASSERT_EQUAL_INT(13 + i, board.channel[i].gpio_num);
        TEST_ASSERT_EQUAL_INT(0, board.channel[i].hpoint);
    }
}

static void test_the_frequency_fits_the_resolution(void)
{
    board_reset();

    pwm_start(true);

    /* The divider of 80 MHz, in 1/256: at least 1. */
    const uint64_t divider = (uint64_t{80000000} << 8) / board.timer.freq_hz /
                             (1u << board.timer.duty_resolution);
    TEST_ASSERT_EQUAL_INT(12, board.timer.duty_resolution);
    TEST_ASSERT_EQUAL_UINT32(256, divider);
    TEST_ASSERT_GREATER_THAN(5000, board.timer.freq_hz);
}

static void test_they_start_dark_in_either_polarity(void)
{
    for (const bool common_anode : {false, true}) {
        board_reset();

        pwm_start(common_anode);

        for (int i = 0; i < 3; i++) {
            TEST_ASSERT_EQUAL_UINT32(0, light(i));
            TEST_ASSERT_EQUAL_INT(common_anode,
                                  board.channel[i].flags.output_invert);
        }
    }
}

static void test_a_pin_has_its_dark_level_before_it_becomes_an_output(void)
{
    board_reset();
    pwm_start(true);
    assert_in_order({"gpio_set_level 13 1", "ledc_channel_config 0"});

    board_reset();
    pwm_start(false);
    assert_in_order({"gpio_set_level 15 0", "ledc_channel_config 2"});
}

static void test_duties_are_light_again_where_the_hardware_inverts(void)
{
    const uint16_t duty[3] = {4096, 3096, 0};
    board_reset();
    pwm_start(true);

    pwm_set(duty, true);

    TEST_ASSERT_EQUAL_UINT32(0, light(0));
    TEST_ASSERT_EQUAL_UINT32(1000, light(1));
    TEST_ASSERT_EQUAL_UINT32(4096, light(2)); /* solid on */
}

static void test_duties_pass_where_it_does_not(void)
{
    const uint16_t duty[3] = {4096, 1, 0};
    board_reset();
    pwm_start(false);

    pwm_set(duty, false);

    TEST_ASSERT_EQUAL_UINT32(4096, light(0));
    TEST_ASSERT_EQUAL_UINT32(1, light(1));
    TEST_ASSERT_EQUAL_UINT32(0, light(2));
}

static void test_both_wirings_of_one_decision_give_one_light(void)
{
    led_settings_t settings = dock_default_settings().led;
    for (uint16_t hue = 0; hue < METHOD_HUE_RANGE; hue++) {
        uint16_t duty[3];
        uint32_t upright[3];
        settings.common_anode = false;
        led_duties(duty, hue, &settings);
        board_reset();
        pwm_start(false);
        pwm_set(duty, false);
        memcpy(upright, board.duty, sizeof upright);

        settings.common_anode = true;
        led_duties(duty, hue, &settings);
        board_reset();
        pwm_start(true);
        pwm_set(duty, true);

        TEST_ASSERT_EQUAL_UINT32_ARRAY(upright, board.duty, 3);
    }
}

static void test_only_what_changes_is_written(void)
{
    const uint16_t first[3] = {4096, 96, 4096}, second[3] = {4096, 95, 4096};
    board_reset();
    pwm_start(true);
    pwm_set(first, true);
    board.log.clear();

    pwm_set(first, true);
    TEST_ASSERT_EQUAL_INT(0, board.log.size());
    pwm_set(second, true);
    TEST_ASSERT_EQUAL_INT(1, board.log.size());
    TEST_ASSERT_EQUAL_INT(1, count_in_log("ledc_set_duty 1 4001"));
}

static void test_a_new_polarity_is_configured_and_keeps_the_light(void)
{
    const uint16_t anode[3] = {96, 4096, 0}, cathode[3] = {4000, 0, 4096};
    board_reset();
    pwm_start(true);
    pwm_set(anode, true);

    pwm_set(cathode, false);

    const uint32_t expected[3] = {4000, 0, 4096};
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected, board.duty, 3);
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT(0, board.channel[i].flags.output_invert);
    board.log.clear();
    pwm_set(cathode, false);
    TEST_ASSERT_EQUAL_INT(0, board.log.size());
}

static void run_tests(void)
{
    RUN_TEST(test_open_pins_have_no_pull);
    RUN_TEST(test_the_leds_have_a_group_and_timer_of_their_own);
    RUN_TEST(test_the_frequency_fits_the_resolution);
    RUN_TEST(test_they_start_dark_in_either_polarity);
    RUN_TEST(test_a_pin_has_its_dark_level_before_it_becomes_an_output);
    RUN_TEST(test_duties_are_light_again_where_the_hardware_inverts);
    RUN_TEST(test_duties_pass_where_it_does_not);
    RUN_TEST(test_both_wirings_of_one_decision_give_one_light);
    RUN_TEST(test_only_what_changes_is_written);
    RUN_TEST(test_a_new_polarity_is_configured_and_keeps_the_light);
}

SUITE(run_tests)
