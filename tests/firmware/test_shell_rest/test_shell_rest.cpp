/* Decisions at longer intervals: sensor in standby, processor slow between
 * them.
 */
#include "../../shell/dock_fixture.h"
#include "../suite.h"

static void start_resting_dock(uint16_t decision_ms)
{
    board_reset();
    paint_water();
    dock_settings_t settings = dock_default_settings();
    settings.decision_ms = decision_ms;
    store_in_both(blob_of(settings));
    start_dock();
    run_to_first_frame();
}

static void run_to_standby()
{
    const int64_t began = now_ms();
    while (!board.sensor.standby) {
        turn_both();
        TEST_ASSERT_LESS_THAN(5000, now_ms() - began);
    }
}

static void test_by_default_it_does_not_rest(void)
{
    start_fresh_dock();
    run_to_first_frame();

    run_for(20000);

    TEST_ASSERT_EQUAL_INT(0, count_in_log("standby 1"));
    TEST_ASSERT_EQUAL_INT(0, count_in_log("cpu 80"));
}

static void test_decisions_come_at_the_interval_that_is_set(void)
{
    start_resting_dock(5000);
    const uint32_t frames = dock.decision.frames;

    run_for(60000);

    /* Waking takes some frames more, and a look at the dark one. */
    TEST_ASSERT_INT_WITHIN(2, 12, dock.decision.frames - frames);
    TEST_ASSERT_EQUAL_UINT32(0, dock.camera_faults);
}

static void test_it_rests_most_of_the_time(void)
{
    start_resting_dock(5000);
    int64_t rested = 0;
    const int64_t began = now_ms();

    while (now_ms() < began + 60000) {
        const int64_t before = now_ms();
        const bool resting = board.sensor.standby && board.cpu_mhz == 80;
        turn_both();
        if (resting)
            rested += now_ms() - before;
    }

    TEST_ASSERT_GREATER_THAN(50000, rested);
}

static void test_no_frame_is_being_written_while_it_rests(void)
{
    start_resting_dock(5000);
    run_to_standby();

    TEST_ASSERT_EQUAL_INT(2, frames_out());
    assert_in_order({"standby 1", "cpu 80"});
}

static void test_the_leds_go_on_while_it_rests(void)
{
    start_resting_dock(5000);
    run_to_standby();

    TEST_ASSERT_EQUAL_UINT32(4096, board.duty[2]);
    run_for(3000);
    TEST_ASSERT_EQUAL_UINT32(4096, board.duty[2]);
}

static void test_frames_after_a_rest_began_after_it(void)
{
    start_resting_dock(5000);
    run_to_standby();
    const uint32_t frames = dock.decision.frames;
    board.frame_age_us = 300000;
    while (board.sensor.standby)
        turn_both();
    const int64_t woke = board.us;

    while (dock.decision.frames == frames)
        turn_both();

    TEST_ASSERT_GREATER_OR_EQUAL(woke, board.us - board.frame_age_us);
    TEST_ASSERT_GREATER_OR_EQUAL(3 * board.frame_ms, (board.us - woke) / 1000);
    TEST_ASSERT_EQUAL_UINT32(240, board.cpu_mhz);
}

static void test_a_sensor_that_loses_its_lock_in_standby_is_locked_again(void)
{
    start_resting_dock(5000);
    run_to_standby();
    const uint32_t frames = dock.decision.frames;
    sensor_power_on();
    board.sensor.standby = true;

    while (dock.decision.frames == frames)
        turn_both();

    TEST_ASSERT_TRUE(dock.camera.locked);
    TEST_ASSERT_EQUAL_INT(300, board.sensor.exposure);
    TEST_ASSERT_FALSE(board.sensor.auto_exposure);
}

static void test_an_automatic_camera_does_not_rest(void)
{
    board_reset();
    paint_water();
    dock_settings_t settings = dock_default_settings();
    settings.decision_ms = 5000;
    settings.camera.lock = 0;
    store_in_both(blob_of(settings));
    start_dock();
    run_to_first_frame();

    run_for(10000);

    TEST_ASSERT_EQUAL_INT(0, count_in_log("standby 1"));
}

static void test_a_sensor_without_a_known_standby_does_not_rest(void)
{
    board_reset();
    paint_water();
    board.sensor.pid = GC2145_PID;
    dock_settings_t settings = dock_default_settings();
    settings.decision_ms = 5000;
    store_in_both(blob_of(settings));
    start_dock();
    run_to_first_frame();

    run_for(10000);

    TEST_ASSERT_EQUAL_INT(0, count_in_log("standby 1"));
}

static void test_other_sensors_rest_by_their_own_register(void)
{
    board_reset();
    paint_water();
    board.sensor.pid = OV5640_PID;
    dock_settings_t settings = dock_default_settings();
    settings.decision_ms = 5000;
    store_in_both(blob_of(settings));
    start_dock();
    run_to_first_frame();

    run_to_standby();
}

static void test_a_new_interval_and_new_settings_wake_it(void)
{
    start_resting_dock(10000);
    run_to_standby();
    const uint32_t frames = dock.decision.frames;
    dock.settings.decision_ms = 0;
    run_for(1000);
    TEST_ASSERT_GREATER_THAN(frames + 3, dock.decision.frames);

    dock.settings.decision_ms = 10000;
    run_to_standby();
    dock.settings.camera.exposure = 123;
    dock.settings.camera.gain = 4;
    request(DOCK_REQUEST_CAMERA);
    run_for(1000);
    TEST_ASSERT_EQUAL_INT(123, board.sensor.exposure);
}

static void test_a_snapshot_does_not_wait_for_the_next_decision(void)
{
    start_resting_dock(10000);
    run_to_standby();
    dock.link.snapshot.state = SNAPSHOT_WANTED;

    run_for(1500);

    TEST_ASSERT_NOT_EQUAL(SNAPSHOT_WANTED, dock.link.snapshot.state);
}

static void test_settings_are_saved_and_the_chip_restarts_from_a_rest(void)
{
    start_resting_dock(10000);
    run_to_standby();
    board.log.clear();

    request(DOCK_REQUEST_SAVE);
    run_for(500);
    TEST_ASSERT_EQUAL_INT(1, count_in_log("nvs_commit"));

    run_to_standby();
    request(DOCK_REQUEST_REBOOT);
    try {
        run_for(2000);
        TEST_FAIL_MESSAGE("no restart");
    } catch (const Restarted &) {
    }
}

static void test_a_sensor_that_does_not_wake_is_power_cycled_at_full_speed(void)
{
    for (const char *when : {"standby 1", "standby 0"}) {
        start_resting_dock(2000);
        board.log.clear();
        while (count_in_log(when) == 0) {
            board.sensor.broken =
                board.sensor.standby == (when[8] == '0') ? "standby" : "";
            turn_both();
        }
        board.sensor.broken.clear();
        TEST_ASSERT_EQUAL_INT(1, count_in_log("esp_camera_deinit"));
        TEST_ASSERT_EQUAL_UINT32(240, board.cpu_mhz);

        const uint32_t frames = dock.decision.frames;
        run_for(10000);
        TEST_ASSERT_GREATER_THAN(frames, dock.decision.frames);
    }
}

/* The lamps go out after a frame, and the next one has to come at once. */
static void test_a_look_at_the_dark_is_not_slept_through(void)
{
    start_resting_dock(5000);
    int looks = 0, failures = 0;
    const int64_t began = now_ms();

    while (now_ms() < began + 300000) {
        const bool dark = look_is_on(&dock.look);
        turn_both();
        if (!dark || look_is_on(&dock.look))
            continue;
        ++looks;
        failures += dock.look.failed;
    }

    TEST_ASSERT_GREATER_OR_EQUAL(3, looks);
    TEST_ASSERT_EQUAL_INT(0, failures);
}

static void test_the_watchdog_is_fed_through_the_longest_rests(void)
{
    start_resting_dock(10000);
    int feeds = board.feeds;

    for (int i = 0; i < 10; i++) {
        const int64_t began = now_ms();
        while (board.feeds == feeds)
            turn_both();
        TEST_ASSERT_LESS_THAN(1000 * WATCHDOG_SECONDS, now_ms() - began);
        feeds = board.feeds;
    }
}

static void run_tests(void)
{
    RUN_TEST(test_by_default_it_does_not_rest);
    RUN_TEST(test_decisions_come_at_the_interval_that_is_set);
    RUN_TEST(test_it_rests_most_of_the_time);
    RUN_TEST(test_no_frame_is_being_written_while_it_rests);
    RUN_TEST(test_the_leds_go_on_while_it_rests);
    RUN_TEST(test_frames_after_a_rest_began_after_it);
    RUN_TEST(test_a_sensor_that_loses_its_lock_in_standby_is_locked_again);
    RUN_TEST(test_an_automatic_camera_does_not_rest);
    RUN_TEST(test_a_sensor_without_a_known_standby_does_not_rest);
    RUN_TEST(test_other_sensors_rest_by_their_own_register);
    RUN_TEST(test_a_new_interval_and_new_settings_wake_it);
    RUN_TEST(test_a_snapshot_does_not_wait_for_the_next_decision);
    RUN_TEST(test_settings_are_saved_and_the_chip_restarts_from_a_rest);
    RUN_TEST(test_a_sensor_that_does_not_wake_is_power_cycled_at_full_speed);
    RUN_TEST(test_a_look_at_the_dark_is_not_slept_through);
    RUN_TEST(test_the_watchdog_is_fed_through_the_longest_rests);
}

SUITE(run_tests)
