/* The settings in flash: there, missing, corrupt, not to be written. */
#include "../../shell/shell.h"
#include "../suite.h"

static dock_settings_t settings;

static dock_settings_t own_settings()
{
    dock_settings_t own = dock_default_settings();
    own.window_ms = 700;
    own.led.common_anode = false;
    own.camera.exposure = 321;
    own.link_baud = 115200;
    return own;
}

static void store(const dock_settings_t &stored)
{
    uint8_t blob[SETTINGS_BLOB_BYTES];
    settings_to_blob(&stored, blob);
    board.blob.assign(reinterpret_cast<const char *>(blob), sizeof blob);
    board.stored = true;
}

static void board_with_own_settings()
{
    board_reset();
    store(own_settings());
    memset(static_cast<void *>(&settings), 0xA5, sizeof settings);
}

static void assert_defaults(storage_result_t expected)
{
    TEST_ASSERT_EQUAL_INT(expected, storage_load(&settings));
    const dock_settings_t defaults = dock_default_settings();
    TEST_ASSERT_EQUAL_UINT16(defaults.window_ms, settings.window_ms);
    TEST_ASSERT_EQUAL_UINT32(defaults.link_baud, settings.link_baud);
    TEST_ASSERT_TRUE(dock_settings_are_valid(&settings));
    TEST_ASSERT_EQUAL_INT(0, board.handles_open);
}

static void test_stored_settings_are_loaded(void)
{
    board_with_own_settings();

    TEST_ASSERT_EQUAL_INT(STORAGE_LOADED, storage_load(&settings));

    TEST_ASSERT_EQUAL_UINT16(700, settings.window_ms);
    TEST_ASSERT_FALSE(settings.led.common_anode);
    TEST_ASSERT_EQUAL_UINT16(321, settings.camera.exposure);
    TEST_ASSERT_EQUAL_UINT32(115200, settings.link_baud);
    TEST_ASSERT_EQUAL_INT(0, board.handles_open);
}

static void test_a_first_start_is_not_corrupt(void)
{
    board_reset();
    assert_defaults(STORAGE_MISSING);
}

static void test_a_namespace_without_the_blob_is_not_corrupt(void)
{
    board_with_own_settings();
    board.get_error = ESP_ERR_NVS_NOT_FOUND;
    assert_defaults(STORAGE_MISSING);
}

static void test_each_flipped_bit_is_corrupt(void)
{
    board_with_own_settings();
    const std::string good = board.blob;
    for (size_t bit = 0; bit < 8 * good.size(); bit++) {
        board.blob = good;
        board.blob[bit / 8] = static_cast<char>(good[bit / 8] ^ 1 << bit % 8);
        assert_defaults(STORAGE_CORRUPT);
    }
}

static void test_a_blob_of_another_length_is_corrupt(void)
{
    for (const size_t length :
         {size_t{0}, size_t{1}, size_t{135}, size_t{137}, size_t{4000}}) {
        board_with_own_settings();
        board.blob.resize(length);
        assert_defaults(STORAGE_CORRUPT);
    }
}

static void test_a_value_of_another_type_is_corrupt(void)
{
    board_with_own_settings();
    board.get_error = ESP_ERR_NVS_TYPE_MISMATCH;
    assert_defaults(STORAGE_CORRUPT);
}

static void test_a_flash_that_does_not_open_is_corrupt(void)
{
    board_with_own_settings();
    board.open_error = ESP_ERR_NVS_NOT_INITIALIZED;
    assert_defaults(STORAGE_CORRUPT);
}

static void test_a_partition_that_cannot_be_used_is_erased_and_corrupt(void)
{
    for (const esp_err_t error :
         {ESP_ERR_NVS_NO_FREE_PAGES, ESP_ERR_NVS_NEW_VERSION_FOUND}) {
        board_with_own_settings();
        board.flash_error = error;

        assert_defaults(STORAGE_CORRUPT);

        assert_in_order(
            {"nvs_flash_init", "nvs_flash_erase", "nvs_flash_init"});
    }
}

static void test_nothing_is_erased_for_another_error(void)
{
    board_with_own_settings();
    board.flash_error = ESP_FAIL;

    assert_defaults(STORAGE_CORRUPT);

    TEST_ASSERT_EQUAL_INT(0, count_in_log("nvs_flash_erase"));
}

static void test_what_is_saved_is_loaded(void)
{
    board_reset();

    TEST_ASSERT_TRUE(storage_save(own_settings()));

    TEST_ASSERT_EQUAL_INT(1, count_in_log("nvs_commit"));
    TEST_ASSERT_EQUAL_INT(STORAGE_LOADED, storage_load(&settings));
    TEST_ASSERT_EQUAL_UINT16(700, settings.window_ms);
    TEST_ASSERT_EQUAL_INT(0, board.handles_open);
}

static void test_each_write_error_is_reported(void)
{
    esp_err_t FakeBoard::*const errors[] = {&FakeBoard::open_error,
                                            &FakeBoard::set_error,
                                            &FakeBoard::commit_error};
    for (esp_err_t FakeBoard::*const error : errors) {
        board_reset();
        board.*error = ESP_ERR_NVS_NOT_ENOUGH_SPACE;

        TEST_ASSERT_FALSE(storage_save(own_settings()));

        TEST_ASSERT_EQUAL_INT(0, board.handles_open);
    }
}

static void test_names_fit_into_nvs(void)
{
    TEST_ASSERT_LESS_OR_EQUAL(15, strlen(NAMESPACE));
    TEST_ASSERT_LESS_OR_EQUAL(15, strlen(KEY));
}

static void run_tests(void)
{
    RUN_TEST(test_stored_settings_are_loaded);
    RUN_TEST(test_a_first_start_is_not_corrupt);
    RUN_TEST(test_a_namespace_without_the_blob_is_not_corrupt);
    RUN_TEST(test_each_flipped_bit_is_corrupt);
    RUN_TEST(test_a_blob_of_another_length_is_corrupt);
    RUN_TEST(test_a_value_of_another_type_is_corrupt);
    RUN_TEST(test_a_flash_that_does_not_open_is_corrupt);
    RUN_TEST(test_a_partition_that_cannot_be_used_is_erased_and_corrupt);
    RUN_TEST(test_nothing_is_erased_for_another_error);
    RUN_TEST(test_what_is_saved_is_loaded);
    RUN_TEST(test_each_write_error_is_reported);
    RUN_TEST(test_names_fit_into_nvs);
}

SUITE(run_tests)
