/* What the dock asks of its board, and what the watchdog is told. */
#include "../../shell/dock_fixture.h"
#include "../suite.h"

static void test_an_idle_loop_never_feeds_the_watchdog(void)
{
    start_fresh_dock();

    for (int i = 0; i < 100000; i++)
        loop();

    TEST_ASSERT_EQUAL_INT(0, board.feeds);
}

static void test_bytes_from_the_host_do_not_feed_it(void)
{
    start_fresh_dock();

    for (int i = 0; i < 1000; i++) {
        board.received.append(500, '\xFD');
        loop();
    }

    TEST_ASSERT_EQUAL_INT(0, board.feeds);
}

static void test_each_frame_feeds_it_once(void)
{
    start_fresh_dock();
    run_to_first_frame();
    const uint32_t frames = dock.decision.frames;
    const int feeds = board.feeds;

    run_for(5000);

    TEST_ASSERT_GREATER_THAN(50, board.feeds - feeds);
    TEST_ASSERT_EQUAL_INT(dock.decision.frames - frames, board.feeds - feeds);
}

static void test_each_reported_camera_fault_feeds_it(void)
{
    board_reset();
    board.init_always = ESP_ERR_NOT_FOUND;
    start_dock();

    run_for(60000);

    TEST_ASSERT_INT_WITHIN(10, 60, board.feeds);
    TEST_ASSERT_EQUAL_INT(dock.camera_faults, board.feeds);
}

static void test_settling_does_not_feed_it_and_stays_within_its_time(void)
{
    board_reset();
    paint_water();
    board.frame_ms = 3900; /* as slow as frames can be */
    start_dock();
    const int64_t began = now_ms();

    run_to_first_frame();

    TEST_ASSERT_EQUAL_INT(1, board.feeds);
    TEST_ASSERT_LESS_THAN(1000 * WATCHDOG_SECONDS, now_ms() - began);
}

static void test_a_frame_lights_the_leds_in_the_same_turn(void)
{
    start_fresh_dock();
    while (!dock.decision.decided)
        turn_both();

    /* Green water: blue is +120 degrees from it. */
    TEST_ASSERT_EQUAL_UINT32(0, board.duty[0]);
    TEST_ASSERT_EQUAL_UINT32(0, board.duty[1]);
    TEST_ASSERT_EQUAL_UINT32(4096, board.duty[2]);
}

static void test_the_leds_keep_their_colour_while_the_camera_is_away(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.grabs_to_fail = FOREVER;

    run_for(30000);

    TEST_ASSERT_GREATER_THAN(5, dock.camera_faults);
    TEST_ASSERT_EQUAL_UINT32(4096, board.duty[2]);
}

static void test_a_dock_whose_camera_never_starts_lights_up(void)
{
    board_reset();
    last_hue_keep(UINT16_MAX);
    board.init_always = ESP_ERR_NOT_FOUND;
    start_dock();
    run_for(14000);
    TEST_ASSERT_EQUAL_UINT32(0, board.duty[1]);

    run_for(2000);

    TEST_ASSERT_EQUAL_UINT32(4096, board.duty[1]); /* the fallback */
}

static void test_the_hue_is_kept_over_a_reset(void)
{
    start_fresh_dock();
    run_to_first_frame();
    TEST_ASSERT_EQUAL_UINT16(1024, last_hue());

    board_reset();
    board.init_always = ESP_ERR_NOT_FOUND;
    start_dock();
    run_for(16000);

    TEST_ASSERT_EQUAL_UINT32(0, board.duty[1]);
    TEST_ASSERT_EQUAL_UINT32(4096, board.duty[2]);
}

static void test_memory_without_a_hue_after_power_on_has_none(void)
{
    last_hue_keep(77);
    TEST_ASSERT_EQUAL_UINT16(77, last_hue());
    kept[0] = 78;
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, last_hue());
    kept[0] = kept[1] = 0;
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, last_hue());
}

static void test_the_age_of_a_frame_reaches_back_a_period_before_it_began(void)
{
    Exposure exposure;
    TEST_ASSERT_GREATER_THAN(60000, exposure.age_ms(1000000, 1072000));
    TEST_ASSERT_EQUAL_UINT32(153, exposure.age_ms(1080000, 1152000));
    /* One is missed, one comes late to the dock. */
    TEST_ASSERT_EQUAL_UINT32(153, exposure.age_ms(1240000, 1312000));
    TEST_ASSERT_EQUAL_UINT32(181, exposure.age_ms(1320000, 1420000));
}

static void test_a_camera_that_becomes_slower_has_its_new_period(void)
{
    Exposure exposure;
    for (int64_t us = 0; us < 1000000; us += 80000)
        exposure.age_ms(us, us + 72000);
    uint32_t age = 0;
    for (int64_t us = 1000000; us < 2600000; us += 160000)
        age = exposure.age_ms(us, us + 144000);
    TEST_ASSERT_EQUAL_UINT32(305, age);
}

static bool is_dark()
{
    return board.duty[0] == 0 && board.duty[1] == 0 && board.duty[2] == 0;
}

static void test_the_lamps_go_out_for_a_look_and_come_back_in_time(void)
{
    start_fresh_dock();
    board.frame_ms = 80;
    board.frame_age_us = 72000;
    run_to_first_frame();
    int64_t dark_since = 0, longest = 0;
    int looks = 0;
    for (const int64_t end = now_ms() + 60000; now_ms() < end;) {
        board.while_waiting = loop;
        turn_both();
        if (is_dark() && dark_since == 0)
            dark_since = now_ms();
        if (!is_dark() && dark_since != 0) {
            looks++;
            if (now_ms() - dark_since > longest)
                longest = now_ms() - dark_since;
            dark_since = 0;
        }
    }
    TEST_ASSERT_EQUAL_INT(1, looks);
    TEST_ASSERT_GREATER_OR_EQUAL(80, longest);
    TEST_ASSERT_LESS_THAN(200, longest);
    TEST_ASSERT_TRUE(dock.look.clear);
}

static void test_the_dock_is_told_the_cameras_values(void)
{
    start_fresh_dock();
    TEST_ASSERT_FALSE(dock.camera.locked);

    run_to_first_frame();

    TEST_ASSERT_TRUE(dock.camera.locked);
    TEST_ASSERT_EQUAL_UINT16(300, dock.camera.exposure);
    TEST_ASSERT_EQUAL_UINT8(5, dock.camera.gain);
}

static void test_a_frame_of_another_format_is_refused(void)
{
    start_fresh_dock();
    run_to_first_frame();
    camera_fb_t buffer = camera_fb_t();
    buffer.buf = board.pixels;
    buffer.len = sizeof board.pixels;
    buffer.width = 160;
    buffer.height = 120;
    buffer.format = PIXFORMAT_YUV422;
    frame_t frame = frame_of(buffer);
    TEST_ASSERT_FALSE(frame_is_valid(&frame));

    buffer.format = PIXFORMAT_RGB565;
    frame = frame_of(buffer);
    TEST_ASSERT_TRUE(frame_is_valid(&frame));
}

static int out_at_write;

static void test_flash_is_written_while_the_camera_is_paused(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.log.clear();
    out_at_write = -1;
    board.while_waiting = [] {
        const bool written = count_in_log("nvs_commit") > 0;
        loop();
        if (!written && count_in_log("nvs_commit") > 0)
            out_at_write = frames_out();
    };

    request(DOCK_REQUEST_SAVE);
    run_for(1000);

    /* Every buffer in hand: the driver has none to fill. */
    TEST_ASSERT_EQUAL_INT(2, out_at_write);
    TEST_ASSERT_EQUAL_INT(1, count_in_log("nvs_commit"));
    TEST_ASSERT_FALSE(dock.requests.failed);
}

static void test_capture_goes_on_after_a_save(void)
{
    start_fresh_dock();
    run_to_first_frame();
    request(DOCK_REQUEST_SAVE);
    run_for(1000);
    const uint32_t frames = dock.decision.frames;

    run_for(1000);

    TEST_ASSERT_GREATER_THAN(frames + 8, dock.decision.frames);
    TEST_ASSERT_EQUAL_INT(0, frames_out());
    TEST_ASSERT_EQUAL_INT(0, count_in_log("esp_camera_deinit"));
}

static void test_a_save_that_fails_is_reported_and_capture_goes_on(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.flash.set_error = ESP_ERR_NVS_NOT_ENOUGH_SPACE;
    request(DOCK_REQUEST_SAVE);
    run_for(1000);
    TEST_ASSERT_TRUE(dock.requests.failed);
    const uint32_t frames = dock.decision.frames;

    run_for(1000);

    TEST_ASSERT_GREATER_THAN(frames + 8, dock.decision.frames);
}

static void test_settings_are_saved_without_a_camera(void)
{
    board_reset();
    board.init_always = ESP_ERR_NOT_FOUND;
    start_dock();
    dock.settings.window_ms = 500;

    request(DOCK_REQUEST_SAVE);
    run_for(100);

    dock_settings_t stored;
    TEST_ASSERT_EQUAL_INT(DOCK_STORED_WHOLE, storage_load(&stored));
    TEST_ASSERT_EQUAL_UINT16(500, stored.window_ms);
}

static void test_a_camera_that_fails_while_pausing_does_not_stop_a_save(void)
{
    start_fresh_dock();
    run_to_first_frame();
    board.grabs_to_fail = FOREVER;

    request(DOCK_REQUEST_SAVE);
    run_for(10000);

    TEST_ASSERT_EQUAL_INT(1, count_in_log("nvs_commit"));
    TEST_ASSERT_GREATER_THAN(0, dock.camera_faults);
}

static void test_frames_from_before_a_pause_are_dropped(void)
{
    start_fresh_dock();
    run_to_first_frame();
    Camera &paused = camera;
    camera_order_t order = mailbox_ordered();
    order.pause = true;
    TEST_ASSERT_EQUAL_INT(CAMERA_PAUSED, paused.step(order).event);
    TEST_ASSERT_EQUAL_INT(2, frames_out());
    pass_ms(500); /* the flash is slow */
    order.pause = false;
    const int64_t resumed = board.us;
    board.frame_age_us = 200000;

    const camera_report_t report = [&] {
        for (;;) {
            const camera_report_t next = paused.step(order);
            if (next.event == CAMERA_FRAME)
                return next;
        }
    }();

    TEST_ASSERT_GREATER_OR_EQUAL(resumed, board.us - board.frame_age_us);
    paused.release(report);
}

static void test_new_camera_settings_reach_the_sensor(void)
{
    start_fresh_dock();
    run_to_first_frame();
    dock.settings.camera.exposure = 123;
    dock.settings.camera.gain = 4;
    dock.settings.camera.white_balance = 2;

    request(DOCK_REQUEST_CAMERA);
    run_for(2000);

    TEST_ASSERT_EQUAL_INT(123, board.sensor.exposure);
    TEST_ASSERT_EQUAL_INT(4, board.sensor.gain);
    TEST_ASSERT_EQUAL_INT(2, board.sensor.preset);
    TEST_ASSERT_EQUAL_UINT16(123, dock.camera.exposure);
}

static void test_bytes_that_do_not_fit_are_sent_later_in_order(void)
{
    start_fresh_dock();
    board.fifo = 7;
    run_for(3000);
    const std::string slow = board.sent;
    start_fresh_dock();
    board.fifo = 100000;
    run_for(3000);

    /* The first heartbeat is the same bytes on either line. */
    TEST_ASSERT_GREATER_THAN(20, slow.size());
    TEST_ASSERT_EQUAL_INT(0, slow.compare(0, 20, board.sent, 0, 20));
}

static void test_a_wrapped_clock_does_not_stop_the_dock(void)
{
    board_reset();
    paint_water();
    board.us = (int64_t{1} << 32) * 1000 - 10000000;
    start_dock();
    run_for(8000);
    const uint32_t frames = dock.decision.frames;
    TEST_ASSERT_GREATER_THAN(20, frames);

    run_for(8000);

    TEST_ASSERT_GREATER_THAN(frames + 70, dock.decision.frames);
    TEST_ASSERT_EQUAL_UINT32(0, dock.camera_faults);
}

static void run_tests(void)
{
    RUN_TEST(test_an_idle_loop_never_feeds_the_watchdog);
    RUN_TEST(test_bytes_from_the_host_do_not_feed_it);
    RUN_TEST(test_each_frame_feeds_it_once);
    RUN_TEST(test_each_reported_camera_fault_feeds_it);
    RUN_TEST(test_settling_does_not_feed_it_and_stays_within_its_time);
    RUN_TEST(test_a_frame_lights_the_leds_in_the_same_turn);
    RUN_TEST(test_the_leds_keep_their_colour_while_the_camera_is_away);
    RUN_TEST(test_a_dock_whose_camera_never_starts_lights_up);
    RUN_TEST(test_the_hue_is_kept_over_a_reset);
    RUN_TEST(test_memory_without_a_hue_after_power_on_has_none);
    RUN_TEST(test_the_age_of_a_frame_reaches_back_a_period_before_it_began);
    RUN_TEST(test_a_camera_that_becomes_slower_has_its_new_period);
    RUN_TEST(test_the_lamps_go_out_for_a_look_and_come_back_in_time);
    RUN_TEST(test_the_dock_is_told_the_cameras_values);
    RUN_TEST(test_a_frame_of_another_format_is_refused);
    RUN_TEST(test_flash_is_written_while_the_camera_is_paused);
    RUN_TEST(test_capture_goes_on_after_a_save);
    RUN_TEST(test_a_save_that_fails_is_reported_and_capture_goes_on);
    RUN_TEST(test_settings_are_saved_without_a_camera);
    RUN_TEST(test_a_camera_that_fails_while_pausing_does_not_stop_a_save);
    RUN_TEST(test_frames_from_before_a_pause_are_dropped);
    RUN_TEST(test_new_camera_settings_reach_the_sensor);
    RUN_TEST(test_bytes_that_do_not_fit_are_sent_later_in_order);
    RUN_TEST(test_a_wrapped_clock_does_not_stop_the_dock);
}

SUITE(run_tests)
