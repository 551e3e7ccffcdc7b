/* The whole dock: frames and time in, LED duties out. */
#include "dock.h"

#include <string.h>

#include "fixture.h"
#include "suite.h"

static const colour_t blue_water = {0, 0, 200};
static const colour_t green_water = {0, 200, 0};
static const colour_t grey_water = {120, 120, 120};

static dock_t dock;

static void start_with(dock_settings_t settings)
{
    memset(&dock, 0xA5, sizeof dock);
    dock_init(&dock, &settings);
}

/* Upright duties, so that a bright channel has a high figure. */
static dock_settings_t upright(void)
{
    dock_settings_t settings = dock_default_settings();
    settings.led.common_anode = false;
    return settings;
}

static void start(void)
{
    start_with(upright());
}

static void show(colour_t water, uint32_t now_ms)
{
    const canvas_t canvas = canvas_of(FRAME_RGB888, 80, 60, water);
    dock_frame(&dock, &canvas.frame, now_ms);
    canvas_free_all();
}

static void assert_duties_at(uint32_t now_ms, int red, int green, int blue)
{
    uint16_t duty[3] = {9999, 9999, 9999};
    dock_led_duties(&dock, duty, now_ms);
    TEST_ASSERT_EQUAL_UINT16(red, duty[0]);
    TEST_ASSERT_EQUAL_UINT16(green, duty[1]);
    TEST_ASSERT_EQUAL_UINT16(blue, duty[2]);
}

static void assert_duties(int red, int green, int blue)
{
    assert_duties_at(0, red, green, blue);
}

static void assert_counters(uint32_t frames, uint32_t camera_faults,
                            uint32_t frame_faults)
{
    TEST_ASSERT_EQUAL_UINT32(frames, dock.decision.frames);
    TEST_ASSERT_EQUAL_UINT32(camera_faults, dock.camera_faults);
    TEST_ASSERT_EQUAL_UINT32(frame_faults, dock.decision.frame_faults);
}

static void test_the_leds_are_dark_until_the_first_frame(void)
{
    dock_settings_t settings = upright();
    start_with(settings);
    assert_duties(0, 0, 0);

    settings.led.common_anode = true;
    start_with(settings);
    assert_duties(4096, 4096, 4096);
}

static void test_faults_before_the_first_frame_leave_the_leds_dark(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB888, 8, 6);
    frame_t cut = canvas.frame;
    cut.length--;
    start();

    dock_frame(&dock, NULL, 0);
    dock_frame(&dock, &cut, 33);

    assert_duties(0, 0, 0);
}

static void test_blue_water_lights_the_leds_red(void)
{
    start();
    show(blue_water, 0);
    assert_duties(4096, 0, 0);
}

static void test_the_leds_follow_at_the_next_frame(void)
{
    start();
    show(blue_water, 0);
    show(green_water, 33); /* markers red and blue: magenta in the middle */
    TEST_ASSERT_EQUAL_UINT16(1024, dock.decision.decided_hue);
    TEST_ASSERT_EQUAL_UINT16(1280, dock.decision.steady.shown);
    assert_duties(4096, 0, 4096);

    show(green_water, 2033);
    assert_duties(0, 0, 4096);
}

static void test_the_window_is_that_of_the_settings(void)
{
    dock_settings_t settings = upright();
    settings.window_ms = 100;
    start_with(settings);
    show(blue_water, 0);

    show(green_water, 99);
    TEST_ASSERT_EQUAL_UINT16(1280, dock.decision.steady.shown);
    show(green_water, 199);
    TEST_ASSERT_EQUAL_UINT16(1024, dock.decision.steady.shown);
}

static void test_the_mapping_is_that_of_the_settings(void)
{
    dock_settings_t settings = upright();
    settings.mapping = METHOD_MAPPING_COMPLEMENT;
    start_with(settings);

    show(blue_water, 0);

    assert_duties(4096, 4096, 0);
}

static void test_night_shows_the_fallback_of_the_settings(void)
{
    dock_settings_t settings = upright();
    settings.fallback_hue = 256;
    start_with(settings);

    show((colour_t){0, 0, 0}, 0);

    assert_duties(4096, 4096, 0);
}

static void test_a_missing_frame_is_a_camera_fault(void)
{
    canvas_t canvas = canvas_new(FRAME_RGB888, 80, 60);
    start();
    show(blue_water, 0);

    dock_frame(&dock, NULL, 33);
    canvas.frame.bytes = NULL;
    dock_frame(&dock, &canvas.frame, 66);

    assert_counters(1, 2, 0);
    assert_duties(4096, 0, 0);
}

/* Green water in a frame spoilt by the caller: the dock stays with red. */
static void assert_refused(frame_t spoilt)
{
    start();
    const canvas_t water = canvas_of(FRAME_RGB888, 80, 60, blue_water);
    dock_frame(&dock, &water.frame, 0);

    dock_frame(&dock, &spoilt, 33);

    assert_counters(1, 0, 1);
    assert_duties(4096, 0, 0);
    TEST_ASSERT_EQUAL_UINT16(0, dock.decision.decided_hue);
    TEST_ASSERT_EQUAL_UINT8(1, dock.decision.steady.rolling.count);
}

static void test_a_frame_of_the_wrong_length_is_a_fault(void)
{
    frame_t frame = canvas_of(FRAME_RGB888, 80, 60, green_water).frame;
    frame.length--;
    assert_refused(frame);
    frame.length += 2;
    assert_refused(frame);
}

static void test_a_frame_without_size_is_a_fault(void)
{
    frame_t frame = canvas_of(FRAME_RGB888, 80, 60, green_water).frame;
    frame.width = 0;
    assert_refused(frame);
    frame.length = 0;
    assert_refused(frame);
}

static void test_an_unaligned_frame_is_a_fault(void)
{
    frame_t frame = canvas_new(FRAME_RGB888, 80, 60).frame;
    frame.bytes++;
    frame.format = FRAME_RGB565;
    frame.length = 9600;
    assert_refused(frame);
}

static void test_a_frame_of_unknown_format_is_a_fault(void)
{
    frame_t frame = canvas_of(FRAME_RGB888, 80, 60, green_water).frame;
    frame.format = (frame_format_t)2;
    assert_refused(frame);
}

static void test_a_good_frame_after_faults_is_decided_on(void)
{
    start();
    show(blue_water, 0);
    for (uint32_t i = 1; i < 100; i++)
        dock_frame(&dock, NULL, 33 * i);

    show(green_water, 3300);

    assert_counters(2, 99, 0);
    assert_duties(0, 0, 4096);
}

static void test_counters_stay_at_their_most(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB888, 1, 1);
    frame_t cut = canvas.frame;
    cut.length--;
    start();
    dock.decision.frames = UINT32_MAX - 1;
    dock.camera_faults = UINT32_MAX - 1;
    dock.decision.frame_faults = UINT32_MAX - 1;
    for (int i = 0; i < 3; i++) {
        dock_frame(&dock, &canvas.frame, 0);
        dock_frame(&dock, &cut, 0);
        dock_frame(&dock, NULL, 0);

        assert_counters(UINT32_MAX, UINT32_MAX, UINT32_MAX);
    }
}

/* Frames of one water, ten a second; returns the time after them. */
static uint32_t show_for(colour_t water, uint32_t from_ms, uint32_t frames)
{
    for (uint32_t i = 0; i < frames; i++)
        show(water, from_ms + 100 * i);
    return from_ms + 100 * frames;
}

static void test_a_second_of_grey_water_changes_nothing(void)
{
    start();
    uint32_t now = show_for(blue_water, 0, 30);
    now = show_for(grey_water, now, 9);
    assert_duties(4096, 0, 0);
    show_for(blue_water, now, 1);
    assert_duties(4096, 0, 0);
}

static void
test_grey_water_that_lasts_shows_the_fallback_and_nothing_between(void)
{
    start();
    const uint32_t from = show_for(blue_water, 0, 30);
    for (uint32_t now = from; now < from + 3000; now += 100) {
        show(grey_water, now);
        TEST_ASSERT_EQUAL_UINT16(now - from < 900 ? 0 : 512, dock_hue(&dock));
    }
    const uint32_t back = from + 3000;
    for (uint32_t now = back; now < back + 3000; now += 100) {
        show(blue_water, now);
        TEST_ASSERT_EQUAL_UINT16(now - back < 900 ? 512 : 0, dock_hue(&dock));
    }
}

static void test_water_at_the_limit_shows_one_of_both_and_stays_with_it(void)
{
    start();
    for (uint32_t i = 0; i < 300; i++) {
        show(i % 3 == 2 ? grey_water : blue_water, 100 * i);
        TEST_ASSERT_EQUAL_UINT16(0, dock_hue(&dock));
    }
}

static void test_without_a_camera_the_fallback_comes_after_15_seconds(void)
{
    dock_settings_t settings = upright();
    settings.fallback_hue = 256;
    start_with(settings);
    for (uint32_t now = 1000; now < 16000; now += 1000) {
        dock_frame(&dock, NULL, now);
        assert_duties_at(now, 0, 0, 0);
    }
    assert_duties_at(16000, 4096, 4096, 0);
    assert_duties_at(86400000, 4096, 4096, 0);
}

static void test_without_a_camera_the_hue_from_before_the_reset_comes_back(void)
{
    start();
    dock_set_last_hue(&dock, 1024);
    assert_duties_at(0, 0, 0, 0);
    assert_duties_at(15000, 0, 0, 4096);
    TEST_ASSERT_EQUAL_UINT16(1024, dock_hue(&dock));
}

static void test_a_hue_that_is_none_is_not_shown(void)
{
    start();
    dock_set_last_hue(&dock, UINT16_MAX);
    assert_duties_at(0, 0, 0, 0);
    assert_duties_at(15000, 0, 4096, 0);
}

static void test_a_camera_that_comes_late_decides_at_once(void)
{
    start();
    assert_duties_at(0, 0, 0, 0);
    assert_duties_at(20000, 0, 4096, 0);
    show(blue_water, 20100);
    assert_duties_at(20100, 4096, 0, 0);
}

static void run_tests(void)
{
    RUN_TEST(test_a_second_of_grey_water_changes_nothing);
    RUN_TEST(test_grey_water_that_lasts_shows_the_fallback_and_nothing_between);
    RUN_TEST(test_water_at_the_limit_shows_one_of_both_and_stays_with_it);
    RUN_TEST(test_without_a_camera_the_fallback_comes_after_15_seconds);
    RUN_TEST(test_without_a_camera_the_hue_from_before_the_reset_comes_back);
    RUN_TEST(test_a_hue_that_is_none_is_not_shown);
    RUN_TEST(test_a_camera_that_comes_late_decides_at_once);

    RUN_TEST(test_the_leds_are_dark_until_the_first_frame);
    RUN_TEST(test_faults_before_the_first_frame_leave_the_leds_dark);
    RUN_TEST(test_blue_water_lights_the_leds_red);
    RUN_TEST(test_the_leds_follow_at_the_next_frame);
    RUN_TEST(test_the_window_is_that_of_the_settings);
    RUN_TEST(test_the_mapping_is_that_of_the_settings);
    RUN_TEST(test_night_shows_the_fallback_of_the_settings);
    RUN_TEST(test_a_missing_frame_is_a_camera_fault);
    RUN_TEST(test_a_frame_of_the_wrong_length_is_a_fault);
    RUN_TEST(test_a_frame_without_size_is_a_fault);
    RUN_TEST(test_an_unaligned_frame_is_a_fault);
    RUN_TEST(test_a_frame_of_unknown_format_is_a_fault);
    RUN_TEST(test_a_good_frame_after_faults_is_decided_on);
    RUN_TEST(test_counters_stay_at_their_most);
}

SUITE(run_tests)
