/* What a dock is made of: its settings, and state that is all its own. */
#include <string.h>

#include "dock.h"
#include "fixture.h"
#include "suite.h"

static dock_t first, second;

/* Water of slowly changing colour with a lamp in it. */
static canvas_t water(uint32_t frame_number)
{
    const uint32_t i = frame_number;
    const canvas_t canvas = canvas_of(
        FRAME_RGB565, 16, 12, (colour_t){i % 7, 20 + i % 40, 31 - i % 30});
    canvas_set(&canvas, i % 16, i % 12, (colour_t){31, 63, 31});
    return canvas;
}

static void show(dock_t *dock, uint32_t frame_number)
{
    const canvas_t canvas = water(frame_number);
    dock_frame(dock, &canvas.frame, 50 * frame_number);
    canvas_free_all();
}

static void assert_same_dock(dock_t *expected, dock_t *actual)
{
    uint16_t a[3], b[3];
    dock_led_duties(expected, a, 0);
    dock_led_duties(actual, b, 0);
    TEST_ASSERT_EQUAL_UINT16(expected->decision.decided_hue,
                             actual->decision.decided_hue);
    TEST_ASSERT_EQUAL_UINT16(expected->decision.steady.shown,
                             actual->decision.steady.shown);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(a, b, 3);
}

static void test_the_defaults_are_those_of_the_method(void)
{
    const dock_settings_t settings = dock_default_settings();

    TEST_ASSERT_EQUAL_UINT8(METHOD_MAPPING_TERNARY, settings.mapping);
    TEST_ASSERT_EQUAL_UINT16(512, settings.fallback_hue);
    TEST_ASSERT_EQUAL_UINT16(2000, settings.window_ms);
    TEST_ASSERT_FALSE(settings.led.common_anode);
}

static void test_the_ends_of_each_range_are_valid(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.mapping = METHOD_MAPPING_COMPLEMENT;
    settings.fallback_hue = 1535;
    settings.window_ms = 100;
    TEST_ASSERT_EQUAL_INT(0, dock_mend_settings(&settings));
    settings.fallback_hue = 0;
    settings.window_ms = 2000;
    TEST_ASSERT_EQUAL_INT(0, dock_mend_settings(&settings));
}

static void assert_gives_way_to_the_defaults(dock_settings_t settings)
{
    dock_init(&first, &settings);
    const dock_settings_t defaults = dock_default_settings();
    TEST_ASSERT_EQUAL_UINT8(defaults.mapping, first.settings.mapping);
    TEST_ASSERT_EQUAL_UINT16(defaults.fallback_hue,
                             first.settings.fallback_hue);
    TEST_ASSERT_EQUAL_UINT16(defaults.window_ms, first.settings.window_ms);
    TEST_ASSERT_EQUAL_UINT8(defaults.led.gamma, first.settings.led.gamma);
    TEST_ASSERT_EQUAL_INT16(0, first.settings.led.offset[0]);
}

static void test_an_unknown_mapping_gives_way_to_the_defaults(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.mapping = METHOD_MAPPING_COUNT;
    assert_gives_way_to_the_defaults(settings);
}

static void test_a_fallback_beyond_the_circle_gives_way_to_the_defaults(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.fallback_hue = 1536;
    assert_gives_way_to_the_defaults(settings);
}

static void test_a_window_out_of_range_gives_way_to_the_defaults(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.window_ms = 99;
    assert_gives_way_to_the_defaults(settings);
    settings.window_ms = 2001;
    assert_gives_way_to_the_defaults(settings);
}

static void test_invalid_led_settings_give_way_to_the_defaults(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.led.gamma = 4;
    assert_gives_way_to_the_defaults(settings);
    settings = dock_default_settings();
    settings.led.offset[0] = 256;
    assert_gives_way_to_the_defaults(settings);
}

static void test_settings_are_copied(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.window_ms = 700;
    dock_init(&first, &settings);

    memset(&settings, 0xFF, sizeof settings);

    TEST_ASSERT_EQUAL_UINT16(700, first.settings.window_ms);
}

static void test_a_fresh_start_forgets_everything(void)
{
    const dock_settings_t settings = dock_default_settings();
    uint16_t duty[3];
    dock_init(&first, &settings);
    show(&first, 0);
    dock_frame(&first, NULL, 0);

    dock_init(&first, &settings);

    dock_led_duties(&first, duty, 0);
    TEST_ASSERT_EQUAL_UINT16(0, duty[0]);
    TEST_ASSERT_EQUAL_UINT32(0, first.decision.frames);
    TEST_ASSERT_EQUAL_UINT32(0, first.camera_faults);
    TEST_ASSERT_EQUAL_UINT8(0, first.decision.steady.rolling.count);
}

static void test_a_run_equals_its_stages(void)
{
    static whole_image_t image;
    const dock_settings_t settings = dock_default_settings();
    background_t background;
    rolling_t rolling;
    uint16_t duty[3], expected[3];
    dock_init(&first, &settings);
    rolling_init(&rolling);
    for (uint32_t i = 0; i < 100; i++) {
        const canvas_t canvas = water(i);
        whole_image_smoothed(&image, &canvas.frame);
        whole_image_background(&background, &image, 0);
        const uint16_t decided = marker_hue(&background, 0, 512);
        const uint16_t mean = rolling_add(&rolling, decided, 50 * i, 2000);
        led_duties(expected, mean, &settings.led);

        dock_frame(&first, &canvas.frame, 50 * i);

        dock_led_duties(&first, duty, 0);
        TEST_ASSERT_EQUAL_UINT16(decided, first.decision.decided_hue);
        TEST_ASSERT_EQUAL_UINT16(mean, first.decision.steady.shown);
        TEST_ASSERT_EQUAL_UINT16_ARRAY(expected, duty, 3);
        TEST_ASSERT_EQUAL_MEMORY(&background, &first.decision.background,
                                 sizeof background);
        canvas_free_all();
    }
}

static void test_two_docks_do_not_disturb_each_other(void)
{
    static dock_t alone;
    dock_settings_t settings = dock_default_settings();
    dock_init(&first, &settings);
    dock_init(&alone, &settings);
    settings.mapping = METHOD_MAPPING_COMPLEMENT;
    settings.window_ms = 100;
    dock_init(&second, &settings);
    for (uint32_t i = 0; i < 100; i++)
        show(&alone, i);

    for (uint32_t i = 0; i < 100; i++) {
        show(&first, i);
        show(&second, 3 * i);
        dock_frame(&second, NULL, 3 * i);
    }

    assert_same_dock(&alone, &first);
    TEST_ASSERT_EQUAL_UINT32(0, first.camera_faults);
}

static void test_a_dock_may_move_in_memory(void)
{
    static dock_t moved;
    const dock_settings_t settings = dock_default_settings();
    dock_init(&first, &settings);
    dock_init(&second, &settings);
    for (uint32_t i = 0; i < 50; i++) {
        show(&first, i);
        show(&second, i);
    }

    moved = second;
    memset(&second, 0xA5, sizeof second);

    for (uint32_t i = 50; i < 70; i++) {
        show(&first, i);
        show(&moved, i);
    }
    assert_same_dock(&first, &moved);
}

static void run_tests(void)
{
    RUN_TEST(test_the_defaults_are_those_of_the_method);
    RUN_TEST(test_the_ends_of_each_range_are_valid);
    RUN_TEST(test_an_unknown_mapping_gives_way_to_the_defaults);
    RUN_TEST(test_a_fallback_beyond_the_circle_gives_way_to_the_defaults);
    RUN_TEST(test_a_window_out_of_range_gives_way_to_the_defaults);
    RUN_TEST(test_invalid_led_settings_give_way_to_the_defaults);
    RUN_TEST(test_settings_are_copied);
    RUN_TEST(test_a_fresh_start_forgets_everything);
    RUN_TEST(test_a_run_equals_its_stages);
    RUN_TEST(test_two_docks_do_not_disturb_each_other);
    RUN_TEST(test_a_dock_may_move_in_memory);
}

SUITE(run_tests)
