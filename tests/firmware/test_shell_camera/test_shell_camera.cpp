/* The camera's way from power to locked frames, and back after each fault. */
#include "../../shell/camera_fixture.h"
#include "../suite.h"

static void test_frames_are_small_raw_and_the_latest(void)
{
    board_reset();
    Camera camera;

    camera.step(standard_order());

    TEST_ASSERT_EQUAL_INT(PIXFORMAT_RGB565, board.camera_config.pixel_format);
    TEST_ASSERT_EQUAL_INT(FRAMESIZE_QQVGA, board.camera_config.frame_size);
    TEST_ASSERT_EQUAL_INT(2, board.camera_config.fb_count);
    TEST_ASSERT_EQUAL_INT(CAMERA_GRAB_LATEST, board.camera_config.grab_mode);
    TEST_ASSERT_EQUAL_INT(CAMERA_FB_IN_DRAM, board.camera_config.fb_location);
}

static void test_the_pins_are_those_of_the_board(void)
{
    board_reset();
    Camera camera;

    camera.step(standard_order());

    const camera_config_t &c = board.camera_config;
    const int actual[] = {
        c.pin_pwdn,     c.pin_reset, c.pin_xclk, c.pin_sccb_sda,
        c.pin_sccb_scl, c.pin_d7,    c.pin_d6,   c.pin_d5,
        c.pin_d4,       c.pin_d3,    c.pin_d2,   c.pin_d1,
        c.pin_d0,       c.pin_vsync, c.pin_href, c.pin_pclk};
    const int expected[] = {32, -1, 0,  26, 27, 35, 34, 39,
                            36, 21, 19, 18, 5,  25, 23, 22};
    TEST_ASSERT_EQUAL_INT_ARRAY(expected, actual, 16);
}

static void test_no_frame_comes_before_the_lock(void)
{
    board_reset();
    Camera camera;

    const camera_report_t report =
        step_until(camera, CAMERA_FRAME, standard_order());

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_EQUAL_UINT16(300, report.camera.exposure);
    TEST_ASSERT_EQUAL_UINT8(5, report.camera.gain);
    TEST_ASSERT_GREATER_OR_EQUAL(3500, now_ms());
    TEST_ASSERT_LESS_THAN(5000, now_ms());
}

static void test_frames_come_one_by_one_after_that(void)
{
    board_reset();
    Camera camera;
    const camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);

    for (int i = 0; i < 100; i++) {
        const camera_report_t report = camera.step(order);
        TEST_ASSERT_EQUAL_INT(CAMERA_FRAME, report.event);
        TEST_ASSERT_EQUAL_INT(1, frames_out());
        camera.release(report);
        TEST_ASSERT_EQUAL_INT(0, frames_out());
    }
}

/* Every error that a start is known to give. */
static void test_each_start_error_is_a_fault_and_tried_again(void)
{
    const int errors[] = {0x105,   0x106, 0x20001, 0x20002, 0x20003,
                          0x20004, 0x101, 0x103,   -1};
    for (const int error : errors) {
        board_reset();
        board.init_errors = {error};
        Camera camera;

        const camera_report_t report = camera.step(standard_order());

        TEST_ASSERT_EQUAL_INT(CAMERA_FAULT, report.event);
        TEST_ASSERT_FALSE(report.camera.locked);
        step_until(camera, CAMERA_FRAME, standard_order());
        TEST_ASSERT_EQUAL_INT(2, count_in_log("esp_camera_init"));
    }
}

static void test_a_grab_that_times_out_restarts_the_camera(void)
{
    board_reset();
    Camera camera;
    const camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.grabs_to_fail = 1;

    TEST_ASSERT_EQUAL_INT(CAMERA_FAULT, camera.step(order).event);

    TEST_ASSERT_EQUAL_INT(1, count_in_log("esp_camera_deinit"));
    step_until(camera, CAMERA_FRAME, order);
    TEST_ASSERT_EQUAL_INT(2, count_in_log("esp_camera_init"));
}

static void test_a_grab_that_times_out_while_settling_is_a_fault_too(void)
{
    board_reset();
    Camera camera;
    board.grabs_to_fail = 1;

    TEST_ASSERT_EQUAL_INT(CAMERA_FAULT, camera.step(standard_order()).event);
    TEST_ASSERT_TRUE(
        step_until(camera, CAMERA_FRAME, standard_order()).camera.locked);
}

static void test_the_driver_stops_before_the_power_goes(void)
{
    board_reset();
    Camera camera;
    const camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.log.clear();
    board.grabs_to_fail = 1;

    step_until(camera, CAMERA_FRAME, order);

    assert_in_order({"esp_camera_deinit", "gpio_set_level 32 1",
                     "gpio_set_direction 32 2", "gpio_set_level 32 0",
                     "esp_camera_init"});
}

static void test_the_sensor_is_off_until_the_back_off_is_over(void)
{
    board_reset();
    Camera camera;
    board.init_errors = {ESP_ERR_NOT_FOUND};
    const camera_order_t order = standard_order();
    camera.step(order);
    const int64_t failed_ms = now_ms();

    while (now_ms() < failed_ms + 249) {
        TEST_ASSERT_EQUAL_INT(CAMERA_NOTHING, camera.step(order).event);
        TEST_ASSERT_EQUAL_INT(1, board.level[32]);
        pass_ms(1);
    }
    TEST_ASSERT_EQUAL_INT(1, count_in_log("esp_camera_init"));
    pass_ms(1);
    camera.step(order);
    TEST_ASSERT_EQUAL_INT(2, count_in_log("esp_camera_init"));
}

static void test_a_lost_camera_is_reported_every_second(void)
{
    board_reset();
    Camera camera;
    board.init_always = ESP_ERR_NOT_FOUND;
    const camera_order_t order = standard_order();
    for (int i = 0; i < 12; i++)
        step_until(camera, CAMERA_FAULT, order);

    for (int i = 0; i < 100; i++) {
        const int64_t before = now_ms();
        step_until(camera, CAMERA_FAULT, order);
        TEST_ASSERT_LESS_OR_EQUAL(1050, now_ms() - before);
    }
}

static void test_it_never_gives_up(void)
{
    board_reset();
    Camera camera;
    board.init_always = ESP_ERR_NOT_FOUND;
    const camera_order_t order = standard_order();
    while (now_ms() < 24 * 3600 * 1000 && board.log.size() < 100000)
        step_until(camera, CAMERA_FAULT, order);
    /* One start every 16 s and a little. */
    TEST_ASSERT_INT_WITHIN(60, 24 * 3600 / 16, count_in_log("esp_camera_init"));

    board.init_always = ESP_OK;

    TEST_ASSERT_TRUE(step_until(camera, CAMERA_FRAME, order).camera.locked);
    TEST_ASSERT_EQUAL_UINT32(0, camera.retry().delay_ms());
}

static void test_only_a_frame_ends_the_back_off(void)
{
    board_reset();
    Camera camera;
    board.grabs_to_fail = FOREVER; /* it starts, and gives nothing */
    for (int i = 0; i < 3; i++)
        step_until(camera, CAMERA_FAULT, standard_order());

    TEST_ASSERT_EQUAL_UINT32(1000, camera.retry().delay_ms());
}

static void test_a_restart_locks_at_the_same_values(void)
{
    board_reset();
    paint(10, 30, 20); /* the lock is proven once */
    Camera camera;
    const camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.grabs_to_fail = 1;
    board.sensor.settled_exposure = 900; /* what it would settle on now */
    board.sensor.settled_gain = 20;
    step_until(camera, CAMERA_FAULT, order);
    const int64_t failed_ms = now_ms();

    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_EQUAL_UINT16(300, report.camera.exposure);
    TEST_ASSERT_EQUAL_UINT8(5, report.camera.gain);
    TEST_ASSERT_EQUAL_INT(300, board.sensor.exposure);
    TEST_ASSERT_EQUAL_INT(1, board.sensor.preset);
    TEST_ASSERT_LESS_THAN(2000, now_ms() - failed_ms); /* did not settle */
}

static void test_a_white_balance_as_settled_has_to_settle_anew(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    order.settings.white_balance = 0;
    step_until(camera, CAMERA_FRAME, order);
    board.grabs_to_fail = 1;
    board.sensor.settled_exposure = 900;
    step_until(camera, CAMERA_FAULT, order);
    const int64_t failed_ms = now_ms();

    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_GREATER_THAN(3000, now_ms() - failed_ms);
    TEST_ASSERT_FALSE(board.sensor.auto_white);
    TEST_ASSERT_EQUAL_UINT16(300, report.camera.exposure); /* as before */
}

static void test_new_settings_while_it_is_away_are_used_when_it_is_back(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.grabs_to_fail = 1;
    step_until(camera, CAMERA_FAULT, order);
    order.settings.exposure = 77;
    order.settings.white_balance = 4;
    ++order.serial;

    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_EQUAL_UINT16(77, report.camera.exposure);
    TEST_ASSERT_EQUAL_INT(4, board.sensor.preset);
}

static void test_frames_from_before_a_change_are_dropped(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    order.settings.exposure = 200;
    order.settings.gain = 3;
    step_until(camera, CAMERA_FRAME, order);
    order.settings.exposure = 3; /* too short for a check by the picture */
    ++order.serial;
    const int64_t changed_us = board.us;
    board.frame_age_us = 300000; /* began more than three frames ago */

    for (int grabs = 1;; grabs++) {
        const camera_report_t report = camera.step(order);
        if (report.event != CAMERA_FRAME)
            continue;
        const int64_t began = 1000000 * report.frame->timestamp.tv_sec +
                              report.frame->timestamp.tv_usec;
        TEST_ASSERT_GREATER_OR_EQUAL(changed_us, began);
        /* 3 stale by their time, 3 more because a change is late, this. */
        TEST_ASSERT_EQUAL_INT(7, grabs);
        TEST_ASSERT_EQUAL_UINT16(3, report.camera.exposure);
        camera.release(report);
        return;
    }
}

static void test_an_unlocked_camera_delivers_frames_and_follows_the_light(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    order.settings.lock = 0;
    TEST_ASSERT_FALSE(step_until(camera, CAMERA_FRAME, order).camera.locked);

    board.sensor.settled_exposure = 640;
    pass_ms(1000);

    TEST_ASSERT_EQUAL_UINT16(
        640, step_until(camera, CAMERA_FRAME, order).camera.exposure);
    TEST_ASSERT_EQUAL_INT(0, count_in_log("set_exposure_ctrl 0"));
}

static void test_a_wrapped_clock_changes_nothing(void)
{
    board_reset();
    board.us = (int64_t{1} << 32) * 1000 - 2000000; /* 2 s before */
    Camera camera;
    board.init_errors = {ESP_ERR_NOT_FOUND, ESP_ERR_NOT_FOUND};
    const int64_t began_ms = now_ms();

    const camera_report_t report =
        step_until(camera, CAMERA_FRAME, standard_order());

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_LESS_THAN(6000, now_ms() - began_ms);
    for (int i = 0; i < 50; i++) {
        const camera_report_t next = camera.step(standard_order());
        TEST_ASSERT_EQUAL_INT(CAMERA_FRAME, next.event);
        camera.release(next);
    }
}

static void run_tests(void)
{
    RUN_TEST(test_frames_are_small_raw_and_the_latest);
    RUN_TEST(test_the_pins_are_those_of_the_board);
    RUN_TEST(test_no_frame_comes_before_the_lock);
    RUN_TEST(test_frames_come_one_by_one_after_that);
    RUN_TEST(test_each_start_error_is_a_fault_and_tried_again);
    RUN_TEST(test_a_grab_that_times_out_restarts_the_camera);
    RUN_TEST(test_a_grab_that_times_out_while_settling_is_a_fault_too);
    RUN_TEST(test_the_driver_stops_before_the_power_goes);
    RUN_TEST(test_the_sensor_is_off_until_the_back_off_is_over);
    RUN_TEST(test_a_lost_camera_is_reported_every_second);
    RUN_TEST(test_it_never_gives_up);
    RUN_TEST(test_only_a_frame_ends_the_back_off);
    RUN_TEST(test_a_restart_locks_at_the_same_values);
    RUN_TEST(test_a_white_balance_as_settled_has_to_settle_anew);
    RUN_TEST(test_new_settings_while_it_is_away_are_used_when_it_is_back);
    RUN_TEST(test_frames_from_before_a_change_are_dropped);
    RUN_TEST(test_an_unlocked_camera_delivers_frames_and_follows_the_light);
    RUN_TEST(test_a_wrapped_clock_changes_nothing);
}

SUITE(run_tests)
