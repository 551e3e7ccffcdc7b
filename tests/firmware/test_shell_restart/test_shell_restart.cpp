/* A restart that a host asked for: last words, camera, flash, LEDs. */
#include "../../shell/dock_fixture.h"
#include "../suite.h"

/* Turns until the board restarts; how many ms that took, or -1. */
static int64_t ms_to_restart(int64_t at_most)
{
    const int64_t began = now_ms();
    try {
        while (now_ms() < began + at_most)
            turn_both();
    } catch (const Restarted &) {
        return now_ms() - began;
    } catch (const Hung &) {
        TEST_FAIL_MESSAGE("the camera wrote over the loader");
    }
    return -1;
}

/* MAVLink 2 without signatures: 12 bytes around the payload. */
static bool ends_with_a_whole_message(const std::string &bytes)
{
    size_t at = 0;
    while (at + 1 < bytes.size() && bytes[at] == '\xFD')
        at += 12 + static_cast<uint8_t>(bytes[at + 1]);
    return at > 0 && at == bytes.size();
}

static void test_a_reboot_waits_until_all_bytes_are_out(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.wire_idle = false;
    request(DOCK_REQUEST_REBOOT);
    TEST_ASSERT_EQUAL_INT(-1, ms_to_restart(3000));

    board.wire_idle = true;

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(500));
}

static void test_a_reboot_waits_for_a_slow_line(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.fifo = 0; /* full */
    dock.link.reports[REPORT_VERSION].state = REPORT_DUE;
    loop(); /* a message is on its way and does not fit */
    request(DOCK_REQUEST_REBOOT);
    TEST_ASSERT_EQUAL_INT(-1, ms_to_restart(3000));
    board.fifo = 1;

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(60000));
}

static void test_a_host_that_keeps_asking_does_not_put_off_a_reboot(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.fifo = 5; /* slower than what there is to say */
    board.while_waiting = [] {
        dock.link.reports[REPORT_VERSION].state = REPORT_DUE;
        loop();
    };
    run_for(1000);
    request(DOCK_REQUEST_REBOOT);
    int64_t began = now_ms();

    try {
        while (now_ms() < began + 60000) {
            dock.link.reports[REPORT_VERSION].state = REPORT_DUE;
            turn_both();
        }
        TEST_FAIL_MESSAGE("no restart");
    } catch (const Restarted &) {
        began = now_ms() - began;
    }

    TEST_ASSERT_GREATER_OR_EQUAL(LOOP_LAST_WORDS_MS, began);
    TEST_ASSERT_TRUE(ends_with_a_whole_message(board.sent));
}

static void test_a_reboot_leaves_the_leds_dark(void)
{
    start_fresh_dock();
    run_to_first_frame();

    request(DOCK_REQUEST_REBOOT);

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(2000));
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_UINT32(0, board.duty[i]);
}

static void test_the_camera_is_between_frames_when_the_chip_restarts(void)
{
    start_fresh_dock();
    run_to_first_frame();

    request(DOCK_REQUEST_REBOOT);

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(2000));
    TEST_ASSERT_EQUAL_INT(2, frames_out());
}

static void test_a_reboot_while_the_camera_settles_waits_for_it(void)
{
    start_fresh_dock();
    run_for(1000);

    request(DOCK_REQUEST_REBOOT);

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(2000));
}

static void test_a_camera_lost_before_the_restart_does_not_stop_it(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.grabs_to_fail = FOREVER;

    request(DOCK_REQUEST_REBOOT);

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(GRAB_TIMEOUT_MS + 1000));
    TEST_ASSERT_FALSE(board.camera_on);
}

static void test_a_dock_without_a_camera_restarts(void)
{
    board_reset();
    board.init_always = ESP_ERR_NOT_FOUND;
    start_dock();
    run_for(1000);

    request(DOCK_REQUEST_REBOOT);

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(2000));
}

/* The colour task alone: the camera's is in a driver that does not return. */
static void test_a_driver_that_hangs_puts_off_a_restart_for_a_while_only(void)
{
    start_fresh_dock();
    run_to_first_frame();
    request(DOCK_REQUEST_REBOOT);
    const int64_t began = now_ms();

    try {
        while (now_ms() < began + 60000)
            loop();
        TEST_FAIL_MESSAGE("no restart");
    } catch (const Hung &) {
        /* And then the chip's own watchdog. */
    }

    TEST_ASSERT_INT_WITHIN(1000, 10000, now_ms() - began);
}

static void test_a_save_before_a_reboot_is_done_and_once(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.log.clear();

    request(DOCK_REQUEST_SAVE);
    request(DOCK_REQUEST_REBOOT);

    TEST_ASSERT_GREATER_OR_EQUAL(0, ms_to_restart(3000));
    TEST_ASSERT_EQUAL_INT(1, count_in_log("nvs_commit"));
}

static void run_tests(void)
{
    RUN_TEST(test_a_reboot_waits_until_all_bytes_are_out);
    RUN_TEST(test_a_reboot_waits_for_a_slow_line);
    RUN_TEST(test_a_host_that_keeps_asking_does_not_put_off_a_reboot);
    RUN_TEST(test_a_reboot_leaves_the_leds_dark);
    RUN_TEST(test_the_camera_is_between_frames_when_the_chip_restarts);
    RUN_TEST(test_a_reboot_while_the_camera_settles_waits_for_it);
    RUN_TEST(test_a_camera_lost_before_the_restart_does_not_stop_it);
    RUN_TEST(test_a_dock_without_a_camera_restarts);
    RUN_TEST(test_a_driver_that_hangs_puts_off_a_restart_for_a_while_only);
    RUN_TEST(test_a_save_before_a_reboot_is_done_and_once);
}

SUITE(run_tests)
