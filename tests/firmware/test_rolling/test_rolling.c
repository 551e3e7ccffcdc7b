/* The circular mean of the last decisions. */
#include "rolling.h"

#include <string.h>

#include "fixture.h"
#include "hue.h"
#include "suite.h"

static rolling_t rolling;

static void start(void)
{
    memset(&rolling, 0xA5, sizeof rolling);
    rolling_init(&rolling);
}

static uint16_t add(uint16_t hue, uint32_t now_ms)
{
    return rolling_add(&rolling, hue, now_ms, 2000);
}

static void test_one_decision_is_its_own_mean(void)
{
    for (uint16_t hue = 0; hue < 1536; hue++) {
        start();
        TEST_ASSERT_EQUAL_UINT16(hue, add(hue, 5));
    }
}

static void test_two_decisions_meet_in_the_middle(void)
{
    start();
    add(100, 0);
    TEST_ASSERT_EQUAL_UINT16(150, add(200, 33));
}

static void test_the_mean_about_red_is_red(void)
{
    start();
    add(1500, 0);
    TEST_ASSERT_EQUAL_UINT16(0, add(36, 33));
    TEST_ASSERT_EQUAL_UINT16(1524, add(1500, 66)); /* -36 / 3 */
}

static void test_a_decision_counts_until_it_is_as_old_as_the_window(void)
{
    start();
    add(0, 1000);
    TEST_ASSERT_EQUAL_UINT16(50, add(100, 2999));
    TEST_ASSERT_EQUAL_UINT16(100, add(100, 3000));
    TEST_ASSERT_EQUAL_UINT8(2, rolling.count);
}

static void test_the_window_is_the_callers(void)
{
    start();
    rolling_add(&rolling, 0, 0, 100);
    TEST_ASSERT_EQUAL_UINT16(50, rolling_add(&rolling, 100, 99, 100));
    TEST_ASSERT_EQUAL_UINT16(100, rolling_add(&rolling, 100, 100, 100));
}

static void test_the_clock_may_wrap(void)
{
    start();
    add(0, UINT32_MAX - 999);
    TEST_ASSERT_EQUAL_UINT16(50, add(100, 999)); /* 1999 ms later */
    TEST_ASSERT_EQUAL_UINT16(100, add(100, 1000));
}

static void test_thirty_a_second_for_two_seconds_are_kept(void)
{
    start();
    for (uint32_t i = 0; i < 300; i++)
        add(7, i * 1000 / 30);

    TEST_ASSERT_EQUAL_UINT8(60, rolling.count);
}

static void test_the_window_holds_sixty_decisions(void)
{
    start();
    add(0, 0);
    for (int i = 0; i < 58; i++)
        add(384, 0);
    /* 59 to one: atan(59) is 89.03 degrees */
    TEST_ASSERT_EQUAL_UINT16(380, add(384, 0));
    TEST_ASSERT_EQUAL_UINT8(60, rolling.count);
}

static void test_the_sixty_first_decision_pushes_out_the_oldest(void)
{
    start();
    add(0, 0);
    for (int i = 0; i < 59; i++)
        add(384, 0);
    TEST_ASSERT_EQUAL_UINT16(384, add(384, 0));
    TEST_ASSERT_EQUAL_UINT8(60, rolling.count);
}

static void test_a_slow_camera_has_few_decisions_in_the_window(void)
{
    start();
    add(0, 0);
    add(300, 1000);
    TEST_ASSERT_EQUAL_UINT16(450, add(600, 2000)); /* 300 and 600 */
    TEST_ASSERT_EQUAL_UINT16(750, add(900, 3000));
}

static void test_a_camera_slower_than_the_window_has_one(void)
{
    start();
    for (uint32_t i = 0; i < 100; i++)
        TEST_ASSERT_EQUAL_UINT16(15 * i, add((uint16_t)(15 * i), 2500 * i));
    TEST_ASSERT_EQUAL_UINT8(1, rolling.count);
}

static void test_after_a_pause_only_the_newest_counts(void)
{
    start();
    for (uint32_t i = 0; i < 60; i++)
        add(200, 33 * i);
    TEST_ASSERT_EQUAL_UINT16(900, add(900, 60000));
    TEST_ASSERT_EQUAL_UINT16(950, add(1000, 60033));
}

static void test_decisions_of_the_future_are_dropped(void)
{
    start();
    add(10, 5000);
    add(20, 5033);
    TEST_ASSERT_EQUAL_UINT16(600, add(600, 40)); /* the clock was set back */
    TEST_ASSERT_EQUAL_UINT16(605, add(610, 73));
}

static void test_dropped_decisions_do_not_come_back(void)
{
    start();
    add(10, 5000);
    add(600, 4990);
    TEST_ASSERT_EQUAL_UINT16(600, add(600, 5001));
    TEST_ASSERT_EQUAL_UINT8(2, rolling.count);
}

static void test_opposite_hues_leave_the_newest(void)
{
    start();
    add(100, 0);
    TEST_ASSERT_EQUAL_UINT16(868, add(868, 33));
    start();
    add(868, 0);
    TEST_ASSERT_EQUAL_UINT16(100, add(100, 33));
}

static void test_a_fresh_start_forgets(void)
{
    start();
    add(100, 0);
    rolling_init(&rolling);
    TEST_ASSERT_EQUAL_UINT16(500, add(500, 33));
}

/* All decisions ever made, and their mean by walking over every one. */
static struct {
    uint32_t time_ms[2000];
    uint16_t hue[2000];
} history;

static uint16_t mean_of_history(uint32_t newest)
{
    hue_vector_t sum = {0, 0};
    uint16_t mean = history.hue[newest];
    for (uint32_t i = newest > 59 ? newest - 59 : 0; i <= newest; i++) {
        if (history.time_ms[newest] - history.time_ms[i] < 2000) {
            sum.x += hue_cos(history.hue[i]);
            sum.y += hue_sin(history.hue[i]);
        }
    }
    hue_of_vector(sum, &mean);
    return mean;
}

static void test_any_sequence_gives_the_mean_of_its_history(void)
{
    uint32_t state = 5, now = UINT32_MAX - 30000;
    start();
    for (uint32_t i = 0; i < 2000; i++) {
        /* now faster than 30 Hz, now slower, some pauses */
        now += noise(&state) % (i % 400 < 200 ? 40 : 300);
        now += noise(&state) % 100 == 0 ? 2500 : 0;
        history.time_ms[i] = now;
        history.hue[i] = (uint16_t)((2 * i + noise(&state) % 200) % 1536);

        TEST_ASSERT_EQUAL_UINT16(mean_of_history(i), add(history.hue[i], now));
    }
}

static void run_tests(void)
{
    RUN_TEST(test_one_decision_is_its_own_mean);
    RUN_TEST(test_two_decisions_meet_in_the_middle);
    RUN_TEST(test_the_mean_about_red_is_red);
    RUN_TEST(test_a_decision_counts_until_it_is_as_old_as_the_window);
    RUN_TEST(test_the_window_is_the_callers);
    RUN_TEST(test_the_clock_may_wrap);
    RUN_TEST(test_thirty_a_second_for_two_seconds_are_kept);
    RUN_TEST(test_the_window_holds_sixty_decisions);
    RUN_TEST(test_the_sixty_first_decision_pushes_out_the_oldest);
    RUN_TEST(test_a_slow_camera_has_few_decisions_in_the_window);
    RUN_TEST(test_a_camera_slower_than_the_window_has_one);
    RUN_TEST(test_after_a_pause_only_the_newest_counts);
    RUN_TEST(test_decisions_of_the_future_are_dropped);
    RUN_TEST(test_dropped_decisions_do_not_come_back);
    RUN_TEST(test_opposite_hues_leave_the_newest);
    RUN_TEST(test_a_fresh_start_forgets);
    RUN_TEST(test_any_sequence_gives_the_mean_of_its_history);
}

SUITE(run_tests)
