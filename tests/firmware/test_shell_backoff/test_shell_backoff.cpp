/* When a lost camera is tried again, and when a found one has settled. */
#include "../../shell/shell.h"
#include "../suite.h"

static void test_nothing_failed_is_due_at_once(void)
{
    const Backoff backoff;

    TEST_ASSERT_TRUE(backoff.due(0));
    TEST_ASSERT_EQUAL_UINT32(0, backoff.delay_ms());
}

static void test_a_failure_is_due_after_its_delay_and_not_before(void)
{
    Backoff backoff;

    backoff.fail(1000);

    TEST_ASSERT_FALSE(backoff.due(1249));
    TEST_ASSERT_TRUE(backoff.due(1250));
}

static void test_the_delay_doubles_up_to_its_cap(void)
{
    const uint32_t expected[] = {250,  500,  1000,  2000,
                                 4000, 8000, 16000, 16000};
    Backoff backoff;

    for (const uint32_t delay : expected) {
        backoff.fail(0);
        TEST_ASSERT_EQUAL_UINT32(delay, backoff.delay_ms());
    }
}

static void test_it_is_due_again_after_any_number_of_failures(void)
{
    Backoff backoff;
    for (int i = 0; i < 100000; i++)
        backoff.fail(5);

    TEST_ASSERT_FALSE(backoff.due(5 + 15999));
    TEST_ASSERT_TRUE(backoff.due(5 + 16000));
}

static void test_success_starts_again_at_the_first_delay(void)
{
    Backoff backoff;
    for (int i = 0; i < 5; i++)
        backoff.fail(0);

    backoff.succeed();

    TEST_ASSERT_TRUE(backoff.due(1));
    backoff.fail(10);
    TEST_ASSERT_EQUAL_UINT32(250, backoff.delay_ms());
}

static void test_a_delay_spans_the_clocks_wrap(void)
{
    Backoff backoff;

    backoff.fail(UINT32_MAX - 99); /* 100 ms before 0 */

    TEST_ASSERT_FALSE(backoff.due(0));
    TEST_ASSERT_FALSE(backoff.due(149));
    TEST_ASSERT_TRUE(backoff.due(150));
}

/* Frames at a fixed interval until it has settled; their number. */
static uint32_t frames_to_settle(uint32_t began, uint32_t every, bool known)
{
    Settling settling;
    settling.begin(began, known);
    for (uint32_t frames = 1; frames < 1000; frames++)
        if (settling.frame(began + frames * every))
            return frames;
    return 0;
}

static void test_fast_frames_settle_by_time(void)
{
    TEST_ASSERT_EQUAL_UINT32(100, frames_to_settle(0, 30, false));
}

static void test_slow_frames_settle_by_number(void)
{
    TEST_ASSERT_EQUAL_UINT32(20, frames_to_settle(0, 400, false));
}

static void test_very_slow_frames_do_not_keep_the_dock_dark(void)
{
    TEST_ASSERT_EQUAL_UINT32(3, frames_to_settle(0, 3900, false));
}

static void test_known_values_need_only_the_first_frames_dropped(void)
{
    TEST_ASSERT_EQUAL_UINT32(10, frames_to_settle(0, 30, true));
}

static void test_settling_spans_the_clocks_wrap(void)
{
    TEST_ASSERT_EQUAL_UINT32(100,
                             frames_to_settle(UINT32_MAX - 1000, 30, false));
}

static void run_tests(void)
{
    RUN_TEST(test_nothing_failed_is_due_at_once);
    RUN_TEST(test_a_failure_is_due_after_its_delay_and_not_before);
    RUN_TEST(test_the_delay_doubles_up_to_its_cap);
    RUN_TEST(test_it_is_due_again_after_any_number_of_failures);
    RUN_TEST(test_success_starts_again_at_the_first_delay);
    RUN_TEST(test_a_delay_spans_the_clocks_wrap);
    RUN_TEST(test_fast_frames_settle_by_time);
    RUN_TEST(test_slow_frames_settle_by_number);
    RUN_TEST(test_very_slow_frames_do_not_keep_the_dock_dark);
    RUN_TEST(test_known_values_need_only_the_first_frames_dropped);
    RUN_TEST(test_settling_spans_the_clocks_wrap);
}

SUITE(run_tests)
