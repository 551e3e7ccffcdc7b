/* What happens in which order from power on; the same with either ESP-IDF. */
#ifndef START_CASES_H
#define START_CASES_H

#include "dock_fixture.h"

static void test_the_leds_are_dark_before_anything_else(void)
{
    start_fresh_dock();

    TEST_ASSERT_EQUAL_STRING("gpio_set_direction 13 1", board.log[0].c_str());
    TEST_ASSERT_EQUAL_STRING("gpio_set_direction 14 1", board.log[1].c_str());
    TEST_ASSERT_EQUAL_STRING("gpio_set_direction 15 1", board.log[2].c_str());
}

static void test_everything_starts_in_its_order(void)
{
    start_fresh_dock();

    assert_in_order({"gpio_set_direction 13 1", "nvs_flash_init",
                     "ledc_timer_config", "ledc_channel_config 2",
                     "uart_driver_install", "uart_set_pin 1 3",
                     "xTaskCreateStaticPinnedToCore", "esp_task_wdt_add"});
    TEST_ASSERT_EQUAL_INT(board.log.size() - 1,
                          place_in_log("esp_task_wdt_add"));
}

static void test_the_polarity_is_the_stored_one_from_the_first(void)
{
    board_reset();
    dock_settings_t settings = dock_default_settings();
    settings.led.common_anode = false;
    store_in_nvs(blob_of(settings));

    start_dock();

    TEST_ASSERT_EQUAL_INT(3, count_in_log("ledc_channel_config 0") +
                                 count_in_log("ledc_channel_config 1") +
                                 count_in_log("ledc_channel_config 2"));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(0, board.channel[i].flags.output_invert);
        TEST_ASSERT_EQUAL_UINT32(0, board.duty[i]);
    }
}

static void test_the_leds_stay_dark_to_the_first_decision(void)
{
    start_fresh_dock();

    while (!dock.decision.decided) {
        for (int i = 0; i < 3; i++)
            TEST_ASSERT_EQUAL_UINT32(0, board.duty[i]);
        turn_both();
    }
}

static void test_the_port_has_the_stored_speed(void)
{
    board_reset();
    dock_settings_t settings = dock_default_settings();
    settings.link_baud = 115200;
    store_in_nvs(blob_of(settings));

    start_dock();

    TEST_ASSERT_EQUAL_INT(115200, board.uart.baud_rate);
    TEST_ASSERT_EQUAL_INT(UART_SCLK_APB, board.uart.source_clk);
    TEST_ASSERT_EQUAL_INT(UART_DATA_8_BITS, board.uart.data_bits);
}

static void test_corrupt_settings_start_the_default_dock_and_say_so(void)
{
    board_reset();
    store_in_both(blob_of(dock_default_settings()));
    board.flash.blob[9] ^= 4;
    board.flash.sector[99] ^= 4;

    start_dock();

    TEST_ASSERT_EQUAL_INT(DOCK_STORED_LOST, dock.board.settings);
    TEST_ASSERT_EQUAL_INT(921600, board.uart.baud_rate);
}

static void test_memory_that_arduino_erases_is_restored_and_told(void)
{
    board_reset();
    dock_settings_t settings = dock_default_settings();
    settings.link_baud = 115200;
    settings.led.common_anode = true;
    store_in_both(blob_of(settings));
    board.flash.init_error = ESP_ERR_NVS_NEW_VERSION_FOUND;

    start_dock();

    TEST_ASSERT_EQUAL_INT(1, count_in_log("NVS erased by Arduino"));
    TEST_ASSERT_EQUAL_INT(DOCK_STORED_RESTORED, dock.board.settings);
    TEST_ASSERT_EQUAL_INT(115200, board.uart.baud_rate);
    TEST_ASSERT_TRUE(dock.settings.led.common_anode);
    board.fifo = 100000;
    loop();
    TEST_ASSERT_TRUE(board.sent.find("stored settings damaged: second copy") !=
                     std::string::npos);
}

static void test_a_first_start_says_nothing_of_corrupt_settings(void)
{
    start_fresh_dock();

    TEST_ASSERT_EQUAL_INT(DOCK_STORED_WHOLE, dock.board.settings);
}

static void test_the_dock_knows_its_board(void)
{
    start_fresh_dock();

    TEST_ASSERT_EQUAL_UINT8(ESP_RST_BROWNOUT, dock.board.reset_reason);
    TEST_ASSERT_EQUAL_MEMORY("unknown\0", dock.board.git_hash, 8);
    TEST_ASSERT_EQUAL_UINT32(160 * 120 * 2, dock.board.capacity);
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x240AC4123456), dock.board.uid);
    TEST_ASSERT_EQUAL_INT(0,
                          reinterpret_cast<uintptr_t>(dock.board.buffer) % 2);
}

static void test_the_cameras_task_is_on_the_colours_core(void)
{
    start_fresh_dock();

    TEST_ASSERT_EQUAL_INT(1, board.task_core);
    TEST_ASSERT_NOT_NULL(board.task);
}

static void test_the_watchdog_watches_the_colour_task_and_resets(void)
{
    start_fresh_dock();

    TEST_ASSERT_TRUE(board.watchdog_watching);
    TEST_ASSERT_TRUE(board.watchdog_panics);
    TEST_ASSERT_EQUAL_UINT32(40000, board.watchdog_ms);
    TEST_ASSERT_EQUAL_INT(0, board.feeds);
}

static void run_start_cases(void)
{
    RUN_TEST(test_the_leds_are_dark_before_anything_else);
    RUN_TEST(test_everything_starts_in_its_order);
    RUN_TEST(test_the_polarity_is_the_stored_one_from_the_first);
    RUN_TEST(test_the_leds_stay_dark_to_the_first_decision);
    RUN_TEST(test_the_port_has_the_stored_speed);
    RUN_TEST(test_corrupt_settings_start_the_default_dock_and_say_so);
    RUN_TEST(test_memory_that_arduino_erases_is_restored_and_told);
    RUN_TEST(test_a_first_start_says_nothing_of_corrupt_settings);
    RUN_TEST(test_the_dock_knows_its_board);
    RUN_TEST(test_the_cameras_task_is_on_the_colours_core);
    RUN_TEST(test_the_watchdog_watches_the_colour_task_and_resets);
}

#endif
