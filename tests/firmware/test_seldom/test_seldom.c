/* Frames that come seldom, as with DECISION_MS: what counts is how many say the
 * same, not only for how long.  And times that are longer than half the clock.
 */
#include <string.h>

#include "dock.h"
#include "fixture.h"
#include "suite.h"

#define AGE 50 /* ms: a frame's exposure and reading */

static const colour_t blue = {20, 80, 120}, grey = {90, 90, 90},
                      black = {0, 0, 0};

static dock_t dock;
static uint32_t now, out_since;

static void start(uint16_t rest_ms)
{
    dock_settings_t settings = dock_default_settings();
    settings.decision_ms = rest_ms;
    memset(&dock, 0xA5, sizeof dock);
    dock_init(&dock, &settings);
    now = out_since = 0;
}

static bool drive(void)
{
    uint16_t duty[3];
    dock_led_duties(&dock, duty, now);
    const bool out = duty[0] == 0 && duty[1] == 0 && duty[2] == 0;
    if (!out)
        out_since = now + 1;
    return out;
}

static void give(colour_t colour)
{
    const canvas_t canvas = canvas_of(FRAME_RGB888, 4, 3, colour);
    canvas_t frame = canvas;
    frame.frame.age_ms = AGE;
    dock_frame(&dock, &frame.frame, now);
    canvas_free_all();
    drive();
}

/* After the rest a frame that sees `lit` where the lamps were on for any of its
 * exposure, and `unlit` where they were not. */
static void frame(colour_t lit, colour_t unlit)
{
    const uint32_t rest = dock_rest_ms(&dock) + 2 * AGE;
    for (const uint32_t from = now; now - from < rest; now += 10)
        drive();
    give(drive() && now - out_since >= AGE ? unlit : lit);
}

static void frames(int n, colour_t colour)
{
    while (n-- > 0)
        frame(colour, colour);
}

static colour_t colour_of_hue(uint16_t hue)
{
    const rgb_t rgb = rgb_from_hsv(hue, 200, 180);
    return (colour_t){rgb.red, rgb.green, rgb.blue};
}

static void test_one_frame_of_another_kind_changes_nothing(void)
{
    for (uint16_t rest = 0; rest <= 10000; rest += 2500) {
        start(rest);
        frames(20, blue);
        const uint16_t shown = dock_hue(&dock);
        TEST_ASSERT_NOT_EQUAL(METHOD_FALLBACK_HUE, shown);
        for (int i = 0; i < 5; i++) {
            frames(2, grey);
            TEST_ASSERT_EQUAL_UINT16(shown, dock_hue(&dock));
            frames(1, blue);
            TEST_ASSERT_EQUAL_UINT16(shown, dock_hue(&dock));
        }
    }
}

static void test_three_frames_of_another_kind_are_taken(void)
{
    start(2500);
    frames(20, blue);
    frames(3, grey);
    TEST_ASSERT_EQUAL_UINT16(METHOD_FALLBACK_HUE, dock_hue(&dock));
}

/* Without rests it is the time that counts. */
static void test_frames_that_come_often_are_taken_after_a_second(void)
{
    start(0);
    frames(20, blue);
    const uint16_t shown = dock_hue(&dock);
    const uint32_t from = now;
    while (dock_hue(&dock) == shown && now - from < 5000)
        frames(1, grey);
    TEST_ASSERT_UINT32_WITHIN(2 * AGE + 10, METHOD_HOLD_MS, now - from);
}

/* In dim water a hue that is unlike the one before waits, so that the lamps'
 * hue stays what it is.  The first look is over, the next one is due later. */
static colour_t start_dim(void)
{
    static const colour_t dim_blue = {8, 33, 50};
    start(2500);
    frames(20, dim_blue);
    TEST_ASSERT_TRUE(dock.look.clear);
    const rgb_t rgb = rgb_from_hsv(dock_hue(&dock), 200, 50);
    return (colour_t){rgb.red, rgb.green, rgb.blue};
}

static void test_two_frames_of_the_lamps_hue_are_not_doubted(void)
{
    const colour_t own = start_dim();
    for (int i = 0; i < 2; i++) {
        frames(1, own);
        TEST_ASSERT_TRUE(dock.look.clear);
    }
}

static void test_frames_that_go_on_in_the_lamps_hue_are_doubted(void)
{
    const colour_t own = start_dim();
    frames(3, own);
    TEST_ASSERT_FALSE(dock.look.clear);
}

/* 25 days are more than half the clock's range. */
static void test_lamps_that_show_a_hue_for_a_month_do_not_stop_decisions(void)
{
    start(0);
    for (int i = 0; i < 400 && (i < 40 || dock.look.clear); i++)
        frame(colour_of_hue(dock_hue(&dock)), black);
    TEST_ASSERT_FALSE(dock.look.clear);
    dock.settings.led_mode = 1;
    lamps_follow(&dock.lamps, &dock.settings);

    for (int hours = 0; hours < 25 * 24; hours++) {
        now += 3600000;
        drive();
    }
    frames(400, blue); /* longer than water is waited for at night */

    TEST_ASSERT_EQUAL_UINT16(dock.decision.background.hue,
                             dock.decision.water_hue);
    TEST_ASSERT_TRUE(dock.decision.steady.meaningful);
}

static void run_tests(void)
{
    RUN_TEST(test_one_frame_of_another_kind_changes_nothing);
    RUN_TEST(test_three_frames_of_another_kind_are_taken);
    RUN_TEST(test_frames_that_come_often_are_taken_after_a_second);
    RUN_TEST(test_two_frames_of_the_lamps_hue_are_not_doubted);
    RUN_TEST(test_frames_that_go_on_in_the_lamps_hue_are_doubted);
    RUN_TEST(test_lamps_that_show_a_hue_for_a_month_do_not_stop_decisions);
}

SUITE(run_tests)
