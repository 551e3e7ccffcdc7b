/* What sensor it is, and whether its lock is one. */
#include "../../shell/camera_fixture.h"
#include "../suite.h"

static void test_a_sensor_that_does_not_answer_is_power_cycled(void)
{
    board_reset();
    Camera camera;
    board.sensor.broken = "set_agc_gain";

    const camera_report_t report =
        step_until(camera, CAMERA_FAULT, standard_order());

    TEST_ASSERT_FALSE(report.camera.locked);
    TEST_ASSERT_EQUAL_INT(1, board.level[32]);
    board.sensor.broken.clear();
    TEST_ASSERT_TRUE(
        step_until(camera, CAMERA_FRAME, standard_order()).camera.locked);
}

static void test_a_sensor_that_keeps_its_own_values_is_reported_unlocked(void)
{
    board_reset();
    Camera camera;
    camera_order_t order = standard_order();
    order.settings.exposure = 500;
    board.sensor.deaf = true;

    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_FALSE(report.camera.locked);
    TEST_ASSERT_EQUAL_UINT16(300, report.camera.exposure); /* the truth */
    board.sensor.deaf = false;
    pass_ms(1000);
    TEST_ASSERT_TRUE(step_until(camera, CAMERA_FRAME, order).camera.locked);
}

static void test_a_lock_that_the_picture_follows_is_proven(void)
{
    board_reset();
    paint(10, 30, 20);
    Camera camera;

    const camera_report_t report =
        step_until(camera, CAMERA_FRAME, standard_order());

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_TRUE(report.camera.proven);
    TEST_ASSERT_EQUAL_UINT16(300, report.camera.exposure);
    TEST_ASSERT_EQUAL_INT(300, board.sensor.exposure);
    assert_in_order(
        {"set_aec_value 300", "set_aec_value 150", "set_aec_value 300"});
    TEST_ASSERT_LESS_THAN(6000, now_ms());
}

static void test_a_lock_that_reads_back_and_does_not_hold_is_none(void)
{
    board_reset();
    paint(10, 30, 20);
    board.sensor.unmoved = true;
    Camera camera;
    const camera_order_t order = standard_order();

    for (int i = 0; i < 40; i++) {
        const camera_report_t report = step_until(camera, CAMERA_FRAME, order);
        TEST_ASSERT_FALSE(report.camera.locked);
        TEST_ASSERT_FALSE(report.camera.proven);
    }
    TEST_ASSERT_EQUAL_INT(1, count_in_log("esp_camera_init"));
}

static void test_in_the_dark_a_lock_is_only_read_back(void)
{
    board_reset();
    Camera camera;

    const camera_report_t report =
        step_until(camera, CAMERA_FRAME, standard_order());

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_FALSE(report.camera.proven);
}

static void test_no_frame_of_the_check_reaches_the_dock(void)
{
    board_reset();
    paint(10, 30, 20);
    Camera camera;

    const camera_report_t report = [&] {
        for (;;) {
            const camera_report_t next = camera.step(standard_order());
            if (next.event == CAMERA_FRAME)
                return next;
        }
    }();

    TEST_ASSERT_EQUAL_UINT32(30 * 64, frame_brightness(*report.frame));
    camera.release(report);
}

static void test_a_sensor_that_dies_in_the_check_is_power_cycled(void)
{
    board_reset();
    paint(10, 30, 20);
    Camera camera;
    const camera_order_t order = standard_order();
    while (count_in_log("set_aec_value 300") == 0)
        camera.release(camera.step(order));
    board.sensor.broken = "set_aec_value";

    TEST_ASSERT_FALSE(step_until(camera, CAMERA_FAULT, order).camera.locked);

    board.sensor.broken.clear();
    TEST_ASSERT_TRUE(step_until(camera, CAMERA_FRAME, order).camera.proven);
}

static void test_the_sensor_is_told(void)
{
    for (const int pid : {OV2640_PID, OV3660_PID, GC2145_PID}) {
        board_reset();
        board.sensor.pid = pid == OV2640_PID ? 0 : pid;
        Camera camera;
        TEST_ASSERT_EQUAL_HEX16(
            pid,
            step_until(camera, CAMERA_FRAME, standard_order()).camera.sensor);
        board.grabs_to_fail = 1;
        TEST_ASSERT_EQUAL_HEX16(
            0,
            step_until(camera, CAMERA_FAULT, standard_order()).camera.sensor);
    }
}

/* GC2145: every command returns -1. */
static void test_a_sensor_that_cannot_be_locked_gives_frames_and_no_fault(void)
{
    board_reset();
    board.sensor.pid = GC2145_PID;
    Camera camera;
    camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);
    board.log.clear();

    for (int i = 0; i < 100; i++) {
        const camera_report_t report = camera.step(order);
        TEST_ASSERT_EQUAL_INT(CAMERA_FRAME, report.event);
        TEST_ASSERT_FALSE(report.camera.locked);
        camera.release(report);
    }
    TEST_ASSERT_EQUAL_INT(0, count_in_log("esp_camera_deinit"));
    TEST_ASSERT_EQUAL_INT(0, count_in_log("set_aec_value 0"));

    ++order.serial; /* new settings */
    TEST_ASSERT_FALSE(step_until(camera, CAMERA_FRAME, order).camera.locked);
    TEST_ASSERT_EQUAL_INT(0, count_in_log("esp_camera_deinit"));
}

static void test_a_sensor_that_loses_its_lock_is_locked_again(void)
{
    board_reset();
    Camera camera;
    const camera_order_t order = standard_order();
    step_until(camera, CAMERA_FRAME, order);

    sensor_power_on(); /* a brown-out of the sensor alone */
    pass_ms(1000);
    const camera_report_t report = step_until(camera, CAMERA_FRAME, order);

    TEST_ASSERT_TRUE(report.camera.locked);
    TEST_ASSERT_FALSE(board.sensor.auto_exposure);
    TEST_ASSERT_EQUAL_INT(300, board.sensor.exposure);
    TEST_ASSERT_EQUAL_INT(1, count_in_log("esp_camera_init"));
}

static void run_tests(void)
{
    RUN_TEST(test_a_sensor_that_does_not_answer_is_power_cycled);
    RUN_TEST(test_a_sensor_that_keeps_its_own_values_is_reported_unlocked);
    RUN_TEST(test_a_lock_that_the_picture_follows_is_proven);
    RUN_TEST(test_a_lock_that_reads_back_and_does_not_hold_is_none);
    RUN_TEST(test_in_the_dark_a_lock_is_only_read_back);
    RUN_TEST(test_no_frame_of_the_check_reaches_the_dock);
    RUN_TEST(test_a_sensor_that_dies_in_the_check_is_power_cycled);
    RUN_TEST(test_the_sensor_is_told);
    RUN_TEST(test_a_sensor_that_cannot_be_locked_gives_frames_and_no_fault);
    RUN_TEST(test_a_sensor_that_loses_its_lock_is_locked_again);
}

SUITE(run_tests)
