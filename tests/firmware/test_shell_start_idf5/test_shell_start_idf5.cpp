/* From power on to the first colour, with ESP-IDF 5. */
#define ESP_IDF_VERSION_MAJOR 5

#include "../../shell/start_cases.h"
#include "../suite.h"

static void test_a_watchdog_that_runs_is_configured_not_started(void)
{
    start_fresh_dock();

    TEST_ASSERT_EQUAL_INT(1, count_in_log("esp_task_wdt_reconfigure"));
    TEST_ASSERT_EQUAL_INT(0, count_in_log("esp_task_wdt_init"));
}

static void test_a_watchdog_that_does_not_run_is_started(void)
{
    board_reset();
    board.watchdog_started = false;

    start_dock();

    TEST_ASSERT_TRUE(board.watchdog_started);
    TEST_ASSERT_EQUAL_UINT32(40000, board.watchdog_ms);
}

static void run_tests(void)
{
    run_start_cases();
    RUN_TEST(test_a_watchdog_that_runs_is_configured_not_started);
    RUN_TEST(test_a_watchdog_that_does_not_run_is_started);
}

SUITE(run_tests)
