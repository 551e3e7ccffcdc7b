/* The dock's own light: which frames decide, and when the lamps go out. */
#include <string.h>

#include "dock.h"
#include "fixture.h"
#include "suite.h"

#define PERIOD 80 /* ms */
#define AGE 152   /* a frame's exposure and reading: nearly two periods */

static dock_t dock;
static uint32_t now, dark_since, longest_dark, dark_total;
static bool dark;

/* Water by itself, and what the lamps add, both 0..255 of linear light. */
static double water[3], own_light;
static uint16_t duty[3];
static double lamps[2][3]; /* mean of this period, and of the one before */

static const double dark_water[3] = {0, 0, 0};
static const double blue_water[3] = {0.02, 0.16, 0.35};

static void start(uint8_t mapping)
{
    dock_settings_t settings = dock_default_settings();
    settings.led.common_anode = false;
    settings.mapping = mapping;
    memset(&dock, 0xA5, sizeof dock);
    dock_init(&dock, &settings);
    now = dark_since = longest_dark = dark_total = 0;
    dark = false;
    memset(lamps, 0, sizeof lamps);
}

static void set_scene(const double light[3], double own)
{
    memcpy(water, light, sizeof water);
    own_light = own;
}

/* As a camera encodes light: the inverse of the lamps' decoding by 2.2. */
static uint32_t code_of(double light)
{
    uint32_t code = 0;
    while (code < 255 && led_light((uint8_t)code, 2) < 65535 * light)
        code++;
    return code;
}

static void drive(void)
{
    dock_led_duties(&dock, duty, now);
    const bool out = duty[0] == 0 && duty[1] == 0 && duty[2] == 0;
    if (out && !dark)
        dark_since = now;
    if (!out && dark && dark_since > 0) { /* 0: the start */
        const uint32_t lasted = now - dark_since;
        dark_total += lasted;
        longest_dark = lasted > longest_dark ? lasted : longest_dark;
    }
    dark = out;
}

/* A period: every 5 ms the lamps are driven, at its end a frame comes that was
 * exposed in it and in the one before. */
static void turn(uint32_t age_ms)
{
    memcpy(lamps[1], lamps[0], sizeof lamps[0]);
    memset(lamps[0], 0, sizeof lamps[0]);
    for (uint32_t t = 0; t < PERIOD; t += 5) {
        drive();
        for (int i = 0; i < 3; i++)
            lamps[0][i] += duty[i] / 4096.0 * 5 / PERIOD;
        now += 5;
    }
    uint32_t code[3];
    for (int i = 0; i < 3; i++)
        code[i] =
            code_of(water[i] + own_light * (lamps[0][i] + lamps[1][i]) / 2);
    canvas_t canvas =
        canvas_of(FRAME_RGB888, 4, 3, (colour_t){code[0], code[1], code[2]});
    canvas.frame.age_ms = age_ms;
    dock_frame(&dock, &canvas.frame, now);
    canvas_free_all();
    drive();
}

static void run(uint32_t seconds)
{
    for (const uint32_t end = now + 1000 * seconds; now < end;)
        turn(AGE);
}

static uint32_t degrees(void)
{
    return dock_hue(&dock) * 360 / METHOD_HUE_RANGE;
}

/* The hue shown stays where it is for so long, within five degrees. */
static void assert_steady(uint32_t seconds)
{
    const uint16_t shown = dock_hue(&dock);
    for (const uint32_t end = now + 1000 * seconds; now < end;) {
        turn(AGE);
        TEST_ASSERT_LESS_OR_EQUAL(21, hue_distance(shown, dock_hue(&dock)));
    }
}

static void test_at_night_the_dock_does_not_follow_its_own_light(void)
{
    static const double shares[5] = {0.003, 0.01, 0.03, 0.1, 0.3};
    for (uint8_t mapping = 0; mapping < METHOD_MAPPING_COUNT; mapping++) {
        for (int i = 0; i < 5; i++) {
            start(mapping);
            set_scene(dark_water, shares[i]);
            run(2);
            TEST_ASSERT_EQUAL_UINT32(120, degrees());
            assert_steady(120);
            TEST_ASSERT_FALSE(dock.look.clear);
        }
    }
}

static void test_the_lamps_are_never_out_for_long_nor_often(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0.05);

    run(600);

    TEST_ASSERT_GREATER_THAN(50 * AGE, dark_total);
    TEST_ASSERT_LESS_THAN(200, longest_dark);
    TEST_ASSERT_LESS_OR_EQUAL(12000, dark_total); /* 2 % */
}

static void test_by_day_one_look_a_minute_is_enough(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(blue_water, 0);

    run(600);

    TEST_ASSERT_TRUE(dock.look.clear);
    TEST_ASSERT_LESS_OR_EQUAL(11 * 2 * PERIOD, dark_total);
    TEST_ASSERT_GREATER_OR_EQUAL(9 * PERIOD, dark_total);
}

static void test_by_day_too_only_frames_without_own_light_decide(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(blue_water, 0);
    run(30);
    const uint32_t asked = degrees();

    set_scene(blue_water, 0.1);
    run(120);
    assert_steady(60);

    TEST_ASSERT_FALSE(dock.look.clear);
    TEST_ASSERT_UINT32_WITHIN(3, asked, degrees());
}

static void test_where_own_light_is_gone_all_frames_decide_again(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(blue_water, 0.1);
    run(60);
    TEST_ASSERT_FALSE(dock.look.clear);

    set_scene(blue_water, 0);
    run(30);

    TEST_ASSERT_TRUE(dock.look.clear);
}

static void test_water_that_looks_like_the_lamps_is_doubted_within_seconds(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(blue_water, 0);
    run(30);
    const uint32_t from = now;
    /* As bright as the water, and of the lamps' hue, whatever they show. */
    set_scene(dark_water, 0.5);
    while (dock.look.clear && now - from < 60000)
        turn(AGE);
    TEST_ASSERT_LESS_THAN(2000, now - from);
}

static void test_water_of_the_markers_own_hue_is_not_doubted(void)
{
    static const double brown[3] = {0.2, 0.03, 0.01}; /* contrast has red */
    start(METHOD_MAPPING_CONTRAST);
    set_scene(brown, 0);
    run(10);
    TEST_ASSERT_LESS_THAN(
        30 * METHOD_HUE_RANGE / 360,
        hue_distance(dock.decision.background.hue, dock_hue(&dock)));
    for (const uint32_t end = now + 300000; now < end;) {
        turn(AGE);
        TEST_ASSERT_TRUE(dock.look.clear);
    }
}

static void test_a_frame_that_began_before_the_lamps_were_out_is_no_look(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0.05);
    run(30);
    while (!look_is_on(&dock.look))
        turn(AGE);
    const uint32_t since = dock.look.since_ms;
    const canvas_t canvas =
        canvas_of(FRAME_RGB888, 4, 3, (colour_t){200, 20, 20});
    frame_t frame = canvas.frame;

    now = since + 50;
    frame.age_ms = 51;
    dock_frame(&dock, &frame, now);
    TEST_ASSERT_TRUE(look_is_on(&dock.look));

    frame.age_ms = 50;
    dock_frame(&dock, &frame, now);
    TEST_ASSERT_FALSE(look_is_on(&dock.look));
}

static void test_a_look_without_a_frame_ends_before_a_fifth_of_a_second(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0.05);
    run(30);
    while (!look_is_on(&dock.look))
        turn(AGE);
    const uint32_t since = dock.look.since_ms;
    for (now = since; look_is_on(&dock.look); now += 5)
        drive();
    TEST_ASSERT_LESS_OR_EQUAL(195, now - since);
}

static void test_a_camera_too_slow_for_looks_leaves_the_fallback(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0.05);
    for (const uint32_t end = 120000; now < end;)
        turn(300); /* older than the longest look */
    TEST_ASSERT_EQUAL_UINT32(120, degrees());
    for (const uint32_t end = now + 60000; now < end;) {
        turn(300);
        TEST_ASSERT_EQUAL_UINT32(120, degrees());
    }
}

static void test_a_camera_too_slow_for_looks_follows_the_water_by_day(void)
{
    static const double green_water[3] = {0.02, 0.35, 0.1};
    start(METHOD_MAPPING_TERNARY);
    set_scene(blue_water, 0);
    for (const uint32_t end = 120000; now < end;)
        turn(300);
    set_scene(green_water, 0);
    for (const uint32_t end = now + 30000; now < end;)
        turn(300);
    TEST_ASSERT_UINT32_WITHIN(25, 257, degrees());
}

static void test_a_camera_too_slow_for_looks_sees_night_and_day(void)
{
    start(METHOD_MAPPING_TERNARY);
    set_scene(blue_water, 0.05);
    for (const uint32_t end = now + 60000; now < end;)
        turn(300);
    TEST_ASSERT_UINT32_WITHIN(15, 325, degrees());
    set_scene(dark_water, 0.04);
    for (const uint32_t end = now + 120000; now < end;)
        turn(300);
    TEST_ASSERT_EQUAL_UINT32(120, degrees());
    set_scene(blue_water, 0.04);
    for (const uint32_t end = now + 120000; now < end;)
        turn(300);
    TEST_ASSERT_UINT32_WITHIN(15, 325, degrees());
}

static void test_a_lamp_that_passes_at_night_changes_nothing(void)
{
    static const double lit[3] = {0.03, 0.05, 0.045};
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0);
    run(60);
    const uint16_t shown = dock_hue(&dock);
    set_scene(lit, 0);
    for (const uint32_t end = now + 20000; now < end;) {
        turn(AGE);
        TEST_ASSERT_EQUAL_UINT16(shown, dock_hue(&dock));
    }
    set_scene(dark_water, 0);
    assert_steady(60);
}

static void test_a_lamp_that_passes_at_dawn_is_not_taken_for_the_water(void)
{
    static const double dawn[3] = {0.001, 0.006, 0.012};
    static const double lit[3] = {0.04, 0.05, 0.02};
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0);
    run(60);
    set_scene(dawn, 0);
    run(20);
    TEST_ASSERT_EQUAL_UINT32(120, degrees()); /* it waits */
    set_scene(lit, 0);
    run(20);
    TEST_ASSERT_EQUAL_UINT32(120, degrees());
    set_scene(dawn, 0);
    run(60);
    TEST_ASSERT_UINT32_WITHIN(12, 325, degrees());
}

/* It comes on and goes off over ten seconds each, as one that comes near. */
static void test_a_lamp_that_comes_near_at_dusk_changes_nothing(void)
{
    static const double dusk[3] = {0.001, 0.006, 0.012};
    start(METHOD_MAPPING_TERNARY);
    set_scene(dusk, 0);
    run(120);
    const uint16_t shown = dock_hue(&dock);
    for (const uint32_t from = now; now - from < 20000;) {
        const uint32_t since = now - from;
        const double near = (since < 10000 ? since : 20000 - since) / 10000.0;
        const double seen[3] = {dusk[0] + 0.03 * near, dusk[1] + 0.05 * near,
                                dusk[2] + 0.045 * near};
        set_scene(seen, 0);
        turn(AGE);
        TEST_ASSERT_LESS_OR_EQUAL(21, hue_distance(shown, dock_hue(&dock)));
    }
    set_scene(dusk, 0);
    for (const uint32_t end = now + 120000; now < end;) {
        turn(AGE);
        TEST_ASSERT_LESS_OR_EQUAL(21, hue_distance(shown, dock_hue(&dock)));
    }
}

static void test_at_dawn_the_hue_of_the_water_comes_back(void)
{
    static const double dawn[3] = {0.003, 0.02, 0.04};
    start(METHOD_MAPPING_TERNARY);
    set_scene(dark_water, 0.003);
    run(60);
    TEST_ASSERT_EQUAL_UINT32(120, degrees());
    set_scene(dawn, 0.003);
    run(60);
    TEST_ASSERT_UINT32_WITHIN(12, 325, degrees());
}

static void test_lamps_that_show_something_else_do_not_go_out(void)
{
    start(METHOD_MAPPING_TERNARY);
    dock_settings_t settings = dock.settings;
    settings.led_mode = 1;
    dock_init(&dock, &settings);
    set_scene(dark_water, 0.05);
    for (const uint32_t end = 120000; now < end;) {
        turn(AGE);
        TEST_ASSERT_FALSE(look_is_on(&dock.look));
    }
    /* Nor is a look waited for, which would keep the board from resting. */
    TEST_ASSERT_FALSE(look_waits(&dock.look));
}

static void run_tests(void)
{
    RUN_TEST(test_at_night_the_dock_does_not_follow_its_own_light);
    RUN_TEST(test_the_lamps_are_never_out_for_long_nor_often);
    RUN_TEST(test_by_day_one_look_a_minute_is_enough);
    RUN_TEST(test_by_day_too_only_frames_without_own_light_decide);
    RUN_TEST(test_where_own_light_is_gone_all_frames_decide_again);
    RUN_TEST(test_water_that_looks_like_the_lamps_is_doubted_within_seconds);
    RUN_TEST(test_water_of_the_markers_own_hue_is_not_doubted);
    RUN_TEST(test_a_frame_that_began_before_the_lamps_were_out_is_no_look);
    RUN_TEST(test_a_look_without_a_frame_ends_before_a_fifth_of_a_second);
    RUN_TEST(test_a_camera_too_slow_for_looks_leaves_the_fallback);
    RUN_TEST(test_a_camera_too_slow_for_looks_follows_the_water_by_day);
    RUN_TEST(test_a_camera_too_slow_for_looks_sees_night_and_day);
    RUN_TEST(test_a_lamp_that_passes_at_night_changes_nothing);
    RUN_TEST(test_a_lamp_that_passes_at_dawn_is_not_taken_for_the_water);
    RUN_TEST(test_a_lamp_that_comes_near_at_dusk_changes_nothing);
    RUN_TEST(test_at_dawn_the_hue_of_the_water_comes_back);
    RUN_TEST(test_lamps_that_show_something_else_do_not_go_out);
}

SUITE(run_tests)
