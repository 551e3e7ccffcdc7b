/* From linear light to the duties of an LED: matrix, limit, rounding. */
#include "led_fixture.h"
#include "settings.h"
#include "suite.h"

static void test_matrix_rows_are_outputs_and_columns_inputs(void)
{
    led_settings_t settings = plain();
    settings.matrix[0 * 3 + 2] = 1024; /* a quarter of blue goes to red */
    settings.matrix[1 * 3 + 0] = 2048; /* half of red goes to green */

    assert_duties(1024, 0, 4096, BLUE, settings);
    assert_duties(4096, 2048, 0, RED, settings);
    assert_duties(0, 4096, 0, GREEN, settings);
}

static void test_the_matrix_works_on_linear_light(void)
{
    led_settings_t settings = plain();
    settings.gamma = 2;
    settings.matrix[1 * 3 + 1] = 2048;

    assert_duties(0, 2048, 0, GREEN, settings);
    assert_duties(4096, 450, 0, ORANGE, settings); /* half of 899.1 */
}

static uint8_t limit_at(uint8_t limit, uint8_t dark, uint8_t value)
{
    led_settings_t settings = plain();
    settings.limit = limit;
    settings.dark_limit = dark;
    return led_dimmed(&settings, value).limit;
}

static void test_the_limit_falls_with_the_water_s_value(void)
{
    TEST_ASSERT_EQUAL_UINT8(200, limit_at(200, 20, 255));
    TEST_ASSERT_EQUAL_UINT8(20, limit_at(200, 20, 0));
    TEST_ASSERT_EQUAL_UINT8(110, limit_at(200, 20, 128)); /* 110.35 */
    TEST_ASSERT_EQUAL_UINT8(0, limit_at(255, 0, 0));
    for (int value = 0; value <= 255; value++) {
        TEST_ASSERT_EQUAL_UINT8(value, limit_at(255, 0, (uint8_t)value));
        TEST_ASSERT_EQUAL_UINT8(200, limit_at(200, 200, (uint8_t)value));
        TEST_ASSERT_EQUAL_UINT8(200, limit_at(200, 255, (uint8_t)value));
    }
}

static void test_by_default_nothing_is_dimmed(void)
{
    const led_settings_t settings = dock_default_settings().led;
    for (int value = 0; value <= 255; value++)
        TEST_ASSERT_EQUAL_UINT8(255,
                                led_dimmed(&settings, (uint8_t)value).limit);
}

static void test_less_than_no_light_is_dark(void)
{
    led_settings_t settings = plain();
    settings.matrix[1 * 3 + 0] = -2048;

    assert_duties(4096, 0, 0, RED, settings);
    assert_duties(4096, 8, 0, ORANGE, settings); /* 32896 - 32767.5 */
}

static void test_more_than_full_light_is_full(void)
{
    led_settings_t settings = plain();
    settings.matrix[0] = 8192;

    assert_duties(4096, 0, 0, RED, settings);
}

static void test_the_extremes_of_the_matrix_do_not_overflow(void)
{
    led_settings_t most = plain(), least = plain();
    for (int i = 0; i < 9; i++) {
        most.matrix[i] = INT16_MAX;
        least.matrix[i] = INT16_MIN;
    }
    for (int i = 0; i < 3; i++)
        most.offset[i] = least.offset[i] = 255;

    assert_duties(4096, 4096, 4096, RED, most);
    assert_duties(0, 0, 0, RED, least);
}

static void test_the_limit_dims_all_channels(void)
{
    led_settings_t settings = plain();
    settings.limit = 128;
    assert_duties(2056, 1032, 0, ORANGE, settings); /* 128 / 255 of each */

    settings.limit = 1;
    assert_duties(16, 8, 0, ORANGE, settings);

    settings.limit = 0;
    assert_duties(0, 0, 0, ORANGE, settings);
}

static void test_the_limit_dims_an_inverted_led_too(void)
{
    led_settings_t settings = plain();
    settings.common_anode = true;
    settings.limit = 0;

    assert_duties(4096, 4096, 4096, RED, settings);
}

static void test_the_limit_comes_after_the_matrix(void)
{
    led_settings_t settings = plain();
    settings.matrix[0] = 8192;
    settings.limit = 128;

    assert_duties(2056, 0, 0, RED, settings);
}

/* Of the least colour step, 257 of 65535, `part` / 4096 in green.  A duty of 1
 * starts at 8: these show what becomes of a fraction. */
static int green_duty(int16_t part, uint8_t limit)
{
    led_settings_t settings = plain();
    settings.matrix[1 * 3 + 1] = part;
    settings.limit = limit;
    uint16_t duty[3];
    led_duties(duty, 1, &settings); /* 255, 1, 0 */
    return duty[1];
}

static void test_mixed_light_is_rounded(void)
{
    TEST_ASSERT_EQUAL_INT(0, green_duty(119, 255)); /* 7.47 */
    TEST_ASSERT_EQUAL_INT(1, green_duty(120, 255)); /* 7.53 */
}

static void test_limited_light_is_rounded(void)
{
    TEST_ASSERT_EQUAL_INT(0, green_duty(2048, 14)); /* 129 * 14 / 255: 7.08 */
    TEST_ASSERT_EQUAL_INT(1, green_duty(2048, 15)); /* 7.59 */
}

static void test_duties_are_rounded(void)
{
    TEST_ASSERT_EQUAL_INT(1, green_duty(367, 255)); /* 23 / 65535: 1.44 */
    TEST_ASSERT_EQUAL_INT(2, green_duty(399, 255)); /* 25 / 65535: 1.56 */
}

static void run_tests(void)
{
    RUN_TEST(test_matrix_rows_are_outputs_and_columns_inputs);
    RUN_TEST(test_the_matrix_works_on_linear_light);
    RUN_TEST(test_the_limit_falls_with_the_water_s_value);
    RUN_TEST(test_by_default_nothing_is_dimmed);
    RUN_TEST(test_less_than_no_light_is_dark);
    RUN_TEST(test_more_than_full_light_is_full);
    RUN_TEST(test_the_extremes_of_the_matrix_do_not_overflow);
    RUN_TEST(test_the_limit_dims_all_channels);
    RUN_TEST(test_the_limit_dims_an_inverted_led_too);
    RUN_TEST(test_the_limit_comes_after_the_matrix);
    RUN_TEST(test_mixed_light_is_rounded);
    RUN_TEST(test_limited_light_is_rounded);
    RUN_TEST(test_duties_are_rounded);
}

SUITE(run_tests)
