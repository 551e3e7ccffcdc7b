/* Exposure, gain and white balance: settle, read, fix, read back. */
#include "../../shell/camera_fixture.h"
#include "../suite.h"

static sensor_values_t values;

/* Locks a sensor that was left to its automatic loops. */
static sensor_result_t lock(const camera_settings_t &settings,
                            const sensor_values_t *known = nullptr)
{
    board.log.clear();
    values = sensor_values_t();
    return sensor_lock(&board.sensor.driver, settings, known, &values);
}

static void fresh_sensor()
{
    board_reset();
    sensor_power_on();
}

static void test_the_calls_come_in_their_order(void)
{
    fresh_sensor();

    TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(standard_order().settings));

    const std::vector<std::string> expected = {
        "init_status",    "set_exposure_ctrl 0", "set_aec_value 300",
        "set_aec2 0",     "set_gain_ctrl 0",     "set_agc_gain 5",
        "set_awb_gain 1", "set_wb_mode 1",       "init_status"};
    TEST_ASSERT_EQUAL_INT(expected.size(), board.log.size());
    assert_in_order(expected);
}

static void test_what_is_reported_is_read_back(void)
{
    fresh_sensor();

    lock(standard_order().settings);

    TEST_ASSERT_EQUAL_UINT16(300, values.exposure);
    TEST_ASSERT_EQUAL_UINT8(5, values.gain);
}

static void test_given_values_take_the_place_of_the_settled_ones(void)
{
    fresh_sensor();
    camera_settings_t settings = standard_order().settings;
    settings.exposure = 1200;
    settings.gain = 0;

    TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(settings));

    TEST_ASSERT_EQUAL_INT(1200, board.sensor.exposure);
    TEST_ASSERT_EQUAL_INT(0, board.sensor.gain);
}

static void test_given_values_count_more_than_remembered_ones(void)
{
    fresh_sensor();
    camera_settings_t settings = standard_order().settings;
    settings.exposure = 111;
    const sensor_values_t known = {222, 22};

    TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(settings, &known));

    TEST_ASSERT_EQUAL_UINT16(111, values.exposure);
    TEST_ASSERT_EQUAL_UINT8(22, values.gain);
}

static void test_an_exposure_beyond_the_drivers_range_locks_at_its_end(void)
{
    fresh_sensor();
    board.sensor.settled_exposure = 5000;

    TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(standard_order().settings));

    TEST_ASSERT_EQUAL_UINT16(1200, values.exposure);
}

static void test_each_preset_is_set_and_its_gains_are_checked(void)
{
    for (uint8_t preset = 1; preset <= 4; preset++) {
        fresh_sensor();
        camera_settings_t settings = standard_order().settings;
        settings.white_balance = preset;

        TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(settings));
        TEST_ASSERT_EQUAL_INT(preset, board.sensor.preset);

        board.sensor.changed_gains = 1;
        TEST_ASSERT_EQUAL_INT(SENSOR_DIFFERS, lock(settings));
    }
}

static void test_as_settled_stops_the_automatic_white_balance(void)
{
    fresh_sensor();
    camera_settings_t settings = standard_order().settings;
    settings.white_balance = 0;

    TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(settings));

    TEST_ASSERT_FALSE(board.sensor.auto_white);
    TEST_ASSERT_EQUAL_INT(1, count_in_log("set_awb_gain 1"));
    TEST_ASSERT_EQUAL_INT(0, board.sensor.preset);
}

static void test_each_command_that_is_not_taken_is_a_failure(void)
{
    const char *commands[] = {
        "set_exposure_ctrl", "set_aec_value", "set_aec2",    "set_gain_ctrl",
        "set_agc_gain",      "set_awb_gain",  "set_wb_mode", "get_reg"};
    for (const char *command : commands) {
        fresh_sensor();
        board.sensor.broken = command;
        TEST_ASSERT_EQUAL_INT_MESSAGE(SENSOR_FAILED,
                                      lock(standard_order().settings), command);
    }
}

static void test_a_loop_that_stays_on_is_no_lock(void)
{
    fresh_sensor();
    board.sensor.deaf = true; /* takes set_exposure_ctrl(0) and stays on */

    TEST_ASSERT_EQUAL_INT(SENSOR_DIFFERS, lock(standard_order().settings));
}

static void test_release_makes_everything_automatic(void)
{
    fresh_sensor();
    lock(standard_order().settings);

    TEST_ASSERT_EQUAL_INT(SENSOR_OK, sensor_release(&board.sensor.driver));

    TEST_ASSERT_TRUE(board.sensor.auto_exposure);
    TEST_ASSERT_TRUE(board.sensor.auto_gain);
    TEST_ASSERT_TRUE(board.sensor.auto_white);
    TEST_ASSERT_EQUAL_INT(0, board.sensor.preset);
}

static void test_other_sensors_of_this_kind_are_checked_by_their_registers(void)
{
    for (const int pid : {OV3660_PID, OV5640_PID}) {
        board_reset();
        board.sensor.pid = pid;
        sensor_power_on();
        TEST_ASSERT_EQUAL_INT(SENSOR_OK, lock(standard_order().settings));

        board.sensor.changed_gains = 16;
        TEST_ASSERT_EQUAL_INT(SENSOR_DIFFERS, lock(standard_order().settings));

        board.sensor.broken = "get_reg";
        TEST_ASSERT_EQUAL_INT(SENSOR_FAILED, lock(standard_order().settings));
    }
}

static void test_a_sensor_without_these_commands_differs_and_does_not_fail(void)
{
    board_reset();
    board.sensor.pid = GC2145_PID;
    sensor_power_on();

    TEST_ASSERT_EQUAL_INT(SENSOR_DIFFERS, lock(standard_order().settings));
    TEST_ASSERT_EQUAL_INT(SENSOR_DIFFERS, sensor_release(&board.sensor.driver));
}

/* Frames every 80 ms of a scene whose brightness is told; the proof. */
static lock_proof_t check(const std::function<uint32_t(bool half)> &brightness)
{
    LockCheck check;
    check.begin(1000);
    uint32_t at = 1000;
    for (int frames = 0; !check.over(); frames++) {
        TEST_ASSERT_LESS_THAN(100, frames);
        check.frame(at += 80, brightness(check.half()));
    }
    TEST_ASSERT_FALSE(check.half());
    return check.proof();
}

static void test_a_picture_that_follows_the_exposure_proves_the_lock(void)
{
    TEST_ASSERT_EQUAL_INT(LOCK_PROVEN,
                          check([](bool half) { return half ? 1460 : 2000; }));
    TEST_ASSERT_EQUAL_INT(LOCK_PROVEN,
                          check([](bool half) { return half ? 200 : 400; }));
}

static void test_a_picture_that_stays_refutes_it(void)
{
    TEST_ASSERT_EQUAL_INT(LOCK_REFUTED, check([](bool) { return 2000; }));
    TEST_ASSERT_EQUAL_INT(LOCK_REFUTED,
                          check([](bool half) { return half ? 1900 : 2000; }));
}

static void test_dark_and_white_scenes_prove_nothing(void)
{
    TEST_ASSERT_EQUAL_INT(LOCK_UNPROVEN, check([](bool) { return 0; }));
    TEST_ASSERT_EQUAL_INT(LOCK_UNPROVEN, check([](bool) { return 200; }));
    TEST_ASSERT_EQUAL_INT(LOCK_UNPROVEN, check([](bool) { return 63 * 64; }));
}

static void test_a_scene_that_changes_meanwhile_proves_nothing(void)
{
    uint32_t brightness = 2000;
    TEST_ASSERT_EQUAL_INT(LOCK_UNPROVEN,
                          check([&](bool) { return brightness -= 30; }));
    brightness = 1000;
    TEST_ASSERT_EQUAL_INT(LOCK_UNPROVEN,
                          check([&](bool) { return brightness += 30; }));
}

static void test_frames_that_come_slowly_prove_nothing_and_end_it(void)
{
    LockCheck check;
    check.begin(UINT32_MAX - 1000); /* the clock wraps */
    check.frame(2000, 2000);
    TEST_ASSERT_TRUE(check.half());

    check.frame(UINT32_MAX - 1000 + 4000, 1000);

    TEST_ASSERT_TRUE(check.over());
    TEST_ASSERT_FALSE(check.half());
    TEST_ASSERT_EQUAL_INT(LOCK_UNPROVEN, check.proof());
}

static void test_the_brightness_is_the_mean_of_green(void)
{
    static uint8_t pixels[] = {0x07, 0xE0, 0xF8, 0x1F, 0x00, 0x20, 0x00, 0x00};
    camera_fb_t frame = camera_fb_t();
    frame.buf = pixels;
    frame.len = sizeof pixels;
    TEST_ASSERT_EQUAL_UINT32((63 + 0 + 1 + 0) * 64 / 4,
                             frame_brightness(frame));
    frame.len = 0;
    TEST_ASSERT_EQUAL_UINT32(0, frame_brightness(frame));
}

static void test_new_settings_as_settled_settle_anew(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.sensor.settled_exposure = 450; /* darker water */
    ++order.serial;
    const int64_t before = now_ms();

    TEST_ASSERT_FALSE(camera.step(order).camera.locked);
    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_EQUAL_UINT16(450, report.camera.exposure);
    TEST_ASSERT_GREATER_THAN(3000, now_ms() - before);
}

static void test_settings_that_name_every_value_lock_at_once(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    order.settings.exposure = 50;
    order.settings.gain = 2;
    order.settings.white_balance = 3;
    ++order.serial;
    const int64_t before = now_ms();

    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_EQUAL_UINT16(50, report.camera.exposure);
    TEST_ASSERT_EQUAL_INT(3, board.sensor.preset);
    TEST_ASSERT_LESS_THAN(2000, now_ms() - before); /* the picture's check */
}

/* Values that a host gives while the camera runs, to a sensor whose picture
 * follows the exposure or, `unmoved`, does not. */
static camera_report_t given_while_running(bool unmoved)
{
    board_reset();
    paint(10, 30, 20);
    Camera camera;
    camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.sensor.unmoved = unmoved;
    order.settings.exposure = 200;
    order.settings.gain = 2;
    ++order.serial;
    return step_until(camera, CAMERA_FRAME, order);
}

static void test_values_given_while_it_runs_are_proven_by_the_picture(void)
{
    const camera_report_t report = given_while_running(false);

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_TRUE(report.camera.proven);
    TEST_ASSERT_EQUAL_UINT16(200, report.camera.exposure);
}

static void test_values_given_while_it_runs_without_effect_are_no_lock(void)
{
    const camera_report_t report = given_while_running(true);

    TEST_ASSERT_FALSE(report.camera.locked);
    TEST_ASSERT_FALSE(report.camera.proven);
}

/* A sensor that came up deaf is locked once it listens. */
static void test_a_lock_that_is_repeated_is_proven_by_the_picture(void)
{
    board_reset();
    paint(10, 30, 20);
    board.sensor.deaf = true;
    Camera camera;
    const camera_order_t order = standard_order();
    TEST_ASSERT_FALSE(step_until(camera, CAMERA_FRAME, order).camera.locked);
    board.sensor.deaf = false;
    pass_ms(1000);

    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_TRUE(report.camera.proven);
}

static void run_tests(void)
{
    RUN_TEST(test_the_calls_come_in_their_order);
    RUN_TEST(test_what_is_reported_is_read_back);
    RUN_TEST(test_given_values_take_the_place_of_the_settled_ones);
    RUN_TEST(test_given_values_count_more_than_remembered_ones);
    RUN_TEST(test_an_exposure_beyond_the_drivers_range_locks_at_its_end);
    RUN_TEST(test_each_preset_is_set_and_its_gains_are_checked);
    RUN_TEST(test_as_settled_stops_the_automatic_white_balance);
    RUN_TEST(test_each_command_that_is_not_taken_is_a_failure);
    RUN_TEST(test_a_loop_that_stays_on_is_no_lock);
    RUN_TEST(test_release_makes_everything_automatic);
    RUN_TEST(test_other_sensors_of_this_kind_are_checked_by_their_registers);
    RUN_TEST(test_a_sensor_without_these_commands_differs_and_does_not_fail);
    RUN_TEST(test_a_picture_that_follows_the_exposure_proves_the_lock);
    RUN_TEST(test_a_picture_that_stays_refutes_it);
    RUN_TEST(test_dark_and_white_scenes_prove_nothing);
    RUN_TEST(test_a_scene_that_changes_meanwhile_proves_nothing);
    RUN_TEST(test_frames_that_come_slowly_prove_nothing_and_end_it);
    RUN_TEST(test_the_brightness_is_the_mean_of_green);
    RUN_TEST(test_new_settings_as_settled_settle_anew);
    RUN_TEST(test_settings_that_name_every_value_lock_at_once);
    RUN_TEST(test_values_given_while_it_runs_are_proven_by_the_picture);
    RUN_TEST(test_values_given_while_it_runs_without_effect_are_no_lock);
    RUN_TEST(test_a_lock_that_is_repeated_is_proven_by_the_picture);
}

SUITE(run_tests)
