/* From a hue to the duties of an LED: colour, offset, gamma, polarity. */
#include "led_fixture.h"
#include "settings.h"
#include "suite.h"

static void test_a_pure_hue_lights_its_own_channel_solid(void)
{
    TEST_ASSERT_EQUAL_UINT32(4096, LED_FULL);
    assert_duties(4096, 0, 0, RED, plain());
    assert_duties(0, 4096, 0, GREEN, plain());
    assert_duties(0, 0, 4096, BLUE, plain());
}

static void test_duties_are_proportional_to_light(void)
{
    assert_duties(4096, 2056, 0, ORANGE, plain()); /* 4096 * 128 / 255 */
    assert_duties(4096, 16, 0, 1, plain());        /* 4096 * 1 / 255 */
}

static void test_every_hue_has_a_solid_and_a_dark_channel(void)
{
    const led_settings_t settings = plain();
    for (uint16_t hue = 0; hue < 1536; hue++) {
        uint16_t duty[3];
        led_duties(duty, hue, &settings);
        TEST_ASSERT_TRUE(duty[0] == 4096 || duty[1] == 4096 || duty[2] == 4096);
        TEST_ASSERT_TRUE(duty[0] == 0 || duty[1] == 0 || duty[2] == 0);
    }
}

static void test_common_anode_turns_the_duties_round(void)
{
    led_settings_t settings = plain();
    settings.common_anode = true;

    assert_duties(0, 4096, 4096, RED, settings);
    assert_duties(0, 2040, 4096, ORANGE, settings);
}

static void test_dark_is_dark_with_both_polarities(void)
{
    led_settings_t settings = plain();
    uint16_t duty[3] = {9999, 9999, 9999};

    led_dark(duty, &settings);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(((uint16_t[]){0, 0, 0}), duty, 3);

    settings.common_anode = true;
    led_dark(duty, &settings);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(((uint16_t[]){4096, 4096, 4096}), duty, 3);
}

static void test_gamma_decodes_by_the_chosen_exponent(void)
{
    /* 4096 * (128 / 255) to the power of 1.0, 1.8, 2.2, 2.8 */
    static const int green[4] = {2056, 1185, 899, 595};
    led_settings_t settings = plain();
    for (uint8_t gamma = 0; gamma < 4; gamma++) {
        settings.gamma = gamma;
        assert_duties(4096, green[gamma], 0, ORANGE, settings);
    }
}

static void test_each_offset_moves_its_own_channel(void)
{
    led_settings_t settings = plain();
    settings.offset[0] = -55;
    settings.offset[1] = 72;
    settings.offset[2] = 51;

    /* 200, 200 and 51 of 255 */
    assert_duties(3213, 3213, 819, ORANGE, settings);
}

static void test_offsets_stop_at_dark_and_at_full(void)
{
    led_settings_t settings = plain();
    settings.offset[0] = -255;
    settings.offset[1] = 255;
    settings.offset[2] = -255;

    assert_duties(0, 4096, 0, ORANGE, settings);
}

static void test_offsets_come_before_gamma(void)
{
    led_settings_t settings = plain();
    settings.gamma = 2;
    settings.offset[0] = -55;

    assert_duties(2400, 0, 0, RED, settings); /* 4096 * (200 / 255)^2.2 */
}

static bool are_valid(led_settings_t led)
{
    dock_settings_t settings = dock_default_settings();
    settings.led = led;
    return dock_mend_settings(&settings) == 0;
}

static void test_the_defaults_are_those_of_the_board(void)
{
    const led_settings_t defaults = dock_default_settings().led;

    TEST_ASSERT_TRUE(are_valid(defaults));
    assert_duties(4096, 899, 0, ORANGE, defaults);
}

static void test_an_offset_beyond_255_is_invalid(void)
{
    for (int i = 0; i < 3; i++) {
        led_settings_t settings = plain();
        settings.offset[i] = 255;
        TEST_ASSERT_TRUE(are_valid(settings));
        settings.offset[i] = 256;
        TEST_ASSERT_FALSE(are_valid(settings));
        settings.offset[i] = -255;
        TEST_ASSERT_TRUE(are_valid(settings));
        settings.offset[i] = -256;
        TEST_ASSERT_FALSE(are_valid(settings));
    }
}

static void test_a_gamma_without_a_table_is_invalid(void)
{
    led_settings_t settings = plain();
    settings.gamma = 3;
    TEST_ASSERT_TRUE(are_valid(settings));
    settings.gamma = 4;
    TEST_ASSERT_FALSE(are_valid(settings));
}

static void run_tests(void)
{
    RUN_TEST(test_a_pure_hue_lights_its_own_channel_solid);
    RUN_TEST(test_duties_are_proportional_to_light);
    RUN_TEST(test_every_hue_has_a_solid_and_a_dark_channel);
    RUN_TEST(test_common_anode_turns_the_duties_round);
    RUN_TEST(test_dark_is_dark_with_both_polarities);
    RUN_TEST(test_gamma_decodes_by_the_chosen_exponent);
    RUN_TEST(test_each_offset_moves_its_own_channel);
    RUN_TEST(test_offsets_stop_at_dark_and_at_full);
    RUN_TEST(test_offsets_come_before_gamma);
    RUN_TEST(test_the_defaults_are_those_of_the_board);
    RUN_TEST(test_an_offset_beyond_255_is_invalid);
    RUN_TEST(test_a_gamma_without_a_table_is_invalid);
}

SUITE(run_tests)
