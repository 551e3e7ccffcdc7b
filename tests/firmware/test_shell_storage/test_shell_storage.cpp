/* The settings in flash: there, missing, damaged, not to be written, and the
 * power lost while they are. */
#include "../../shell/shell.h"
#include "../settings_of_table.h"
#include "../suite.h"

static dock_settings_t settings;

static dock_settings_t own_settings()
{
    dock_settings_t own = dock_default_settings();
    own.window_ms = 700;
    own.led.common_anode = true;
    own.camera.exposure = 321;
    own.link_baud = 115200;
    return own;
}

static dock_settings_t newer_settings()
{
    dock_settings_t newer = own_settings();
    newer.window_ms = 1300;
    newer.led.common_anode = false;
    newer.camera.gain = 7;
    newer.link_baud = 9600;
    return newer;
}

static dock_stored_t load()
{
    memset(static_cast<void *>(&settings), 0xA5, sizeof settings);
    const dock_stored_t stored = storage_load(&settings);
    TEST_ASSERT_EQUAL_INT(0, board.flash.handles_open);
    return stored;
}

static bool are(const dock_settings_t &expected)
{
    return blob_of(expected) == blob_of(settings);
}

static void assert_loads(dock_stored_t stored, const dock_settings_t &expected)
{
    TEST_ASSERT_EQUAL_INT(stored, load());
    TEST_ASSERT_TRUE(are(expected));
}

static void board_with_own_settings()
{
    board_reset();
    store_in_both(blob_of(own_settings()));
}

/* Of the sector as settings_sector.cpp writes it. */
static char &sector_byte(size_t at)
{
    return board.flash.sector[8 + at];
}

static void test_stored_settings_are_loaded_and_nothing_is_written(void)
{
    board_with_own_settings();
    board.flash.power = 0;

    assert_loads(DOCK_STORED_WHOLE, own_settings());
}

static void test_a_first_start_is_not_a_loss(void)
{
    board_reset();
    board.flash.power = 0;

    assert_loads(DOCK_STORED_WHOLE, dock_default_settings());
}

static void test_a_partition_of_other_use_is_not_a_loss(void)
{
    board_reset();
    for (size_t i = 0; i < SECTOR_BYTES; i++)
        board.flash.sector[i] = static_cast<char>(i * 7);

    assert_loads(DOCK_STORED_WHOLE, dock_default_settings());
}

static void test_each_flipped_bit_in_nvs_is_restored(void)
{
    const std::string good = blob_of(own_settings());
    for (size_t bit = 0; bit < 8 * good.size(); bit++) {
        board_with_own_settings();
        board.flash.blob[bit / 8] ^= static_cast<char>(1 << bit % 8);

        assert_loads(DOCK_STORED_RESTORED, own_settings());

        TEST_ASSERT_TRUE(board.flash.blob == good);
        assert_loads(DOCK_STORED_WHOLE, own_settings());
    }
}

static void test_each_flipped_bit_in_the_sector_is_written_anew(void)
{
    board_with_own_settings();
    const std::string good = board.flash.sector;
    for (size_t bit = 0; bit < 8 * (8 + SETTINGS_BLOB_BYTES); bit++) {
        board_with_own_settings();
        board.flash.sector[bit / 8] ^= static_cast<char>(1 << bit % 8);

        assert_loads(DOCK_STORED_WHOLE, own_settings());

        TEST_ASSERT_TRUE(board.flash.sector == good);
    }
}

static void test_both_places_damaged_are_a_loss_and_stay_as_they_are(void)
{
    board_with_own_settings();
    board.flash.blob[20] ^= 1;
    sector_byte(30) ^= 1;
    board.flash.power = 0;

    assert_loads(DOCK_STORED_LOST, dock_default_settings());
}

static void test_settings_that_once_were_there_are_a_loss(void)
{
    board_with_own_settings();
    board.flash.stored = false; /* erased by Arduino */
    sector_byte(30) ^= 1;

    assert_loads(DOCK_STORED_LOST, dock_default_settings());
}

static void test_a_value_out_of_range_alone_falls_back_in_either_place(void)
{
    dock_settings_t wrong = own_settings();
    wrong.report_hz = 31;
    dock_settings_t expected = own_settings();
    expected.report_hz = dock_default_settings().report_hz;
    board_reset();
    store_in_both(blob_of(wrong));
    assert_loads(DOCK_STORED_IN_PART, expected);

    board.flash.stored = false;
    assert_loads(DOCK_STORED_IN_PART, expected);
}

static void test_a_blob_cut_at_any_byte_is_restored(void)
{
    const std::string good = blob_of(own_settings());
    for (size_t length = 0; length < good.size(); length++) {
        board_with_own_settings();
        board.flash.blob.resize(length);
        assert_loads(DOCK_STORED_RESTORED, own_settings());
    }
}

static void test_a_blob_too_long_for_any_firmware_is_restored(void)
{
    board_with_own_settings();
    board.flash.blob.resize(4000);
    assert_loads(DOCK_STORED_RESTORED, own_settings());
}

static void test_each_error_of_nvs_is_restored(void)
{
    esp_err_t FakeFlash::*const errors[] = {
        &FakeFlash::init_error, &FakeFlash::open_error, &FakeFlash::get_error};
    for (esp_err_t FakeFlash::*const error : errors) {
        board_with_own_settings();
        board.flash.*error = ESP_ERR_NVS_TYPE_MISMATCH;
        assert_loads(DOCK_STORED_RESTORED, own_settings());
    }
}

static void test_settings_of_the_firmware_before_get_their_second_place(void)
{
    board_reset();
    store_in_nvs(
        std::string(reinterpret_cast<const char *>(OF_TABLE), sizeof OF_TABLE));

    TEST_ASSERT_EQUAL_INT(DOCK_STORED_WHOLE, load());

    TEST_ASSERT_EQUAL_UINT16(872, settings.camera.exposure);
    TEST_ASSERT_EQUAL_UINT8(162, settings.led.limit);
    TEST_ASSERT_EQUAL_UINT32(783418, settings.link_baud);
    board.flash.stored = false;
    TEST_ASSERT_EQUAL_INT(DOCK_STORED_RESTORED, load());
    TEST_ASSERT_EQUAL_UINT16(872, settings.camera.exposure);
}

static void test_without_the_partition_there_is_one_place(void)
{
    board_reset();
    board.flash.without_sector = true;

    TEST_ASSERT_TRUE(storage_save(own_settings()));

    assert_loads(DOCK_STORED_WHOLE, own_settings());
    board.flash.blob[9] ^= 1;
    assert_loads(DOCK_STORED_LOST, dock_default_settings());
}

static void test_what_is_saved_is_in_both_places(void)
{
    board_reset();

    TEST_ASSERT_TRUE(storage_save(own_settings()));

    TEST_ASSERT_EQUAL_INT(1, count_in_log("nvs_commit"));
    assert_loads(DOCK_STORED_WHOLE, own_settings());
    board.flash.stored = false;
    assert_loads(DOCK_STORED_RESTORED, own_settings());
}

static void test_each_write_error_is_reported_and_leaves_old_or_new(void)
{
    esp_err_t FakeFlash::*const errors[] = {
        &FakeFlash::open_error, &FakeFlash::set_error, &FakeFlash::commit_error,
        &FakeFlash::erase_error, &FakeFlash::write_error};
    for (esp_err_t FakeFlash::*const error : errors) {
        board_with_own_settings();
        board.flash.*error = ESP_ERR_NVS_NOT_ENOUGH_SPACE;

        TEST_ASSERT_FALSE(storage_save(newer_settings()));

        TEST_ASSERT_EQUAL_INT(0, board.flash.handles_open);
        board.flash.*error = ESP_OK;
        load();
        TEST_ASSERT_TRUE(are(own_settings()) || are(newer_settings()));
    }
}

/* How power that fails leaves NVS. */
enum harm_t { AS_IT_IS, HALF_A_BLOB, ERASED_BY_ARDUINO, HARMS };

/* A save, broken off after `steps` writes; false if it came to its end. */
static bool save_breaks_off(int steps, harm_t harm)
{
    board_with_own_settings();
    board.flash.torn = harm == HALF_A_BLOB;
    board.flash.power = steps;
    try {
        storage_save(newer_settings());
    } catch (const PowerLost &) {
        /* Then it was NVS that was being written. */
        const bool second_is_whole =
            board.flash.sector.compare(0, 4, "DOCK") == 0 &&
            board.flash.sector.compare(8, SETTINGS_BLOB_BYTES,
                                       blob_of(own_settings())) == 0;
        if (harm == ERASED_BY_ARDUINO && second_is_whole)
            board.flash.init_error = ESP_ERR_NVS_NO_FREE_PAGES;
        return true;
    }
    return false;
}

/* The next start, its writes broken off as well; false if they were not. */
static bool start_breaks_off(int steps)
{
    board.flash.power = steps;
    board.flash.handles_open = 0;
    bool broke_off = false;
    try {
        init_arduino();
        load();
    } catch (const PowerLost &) {
        broke_off = true;
    }
    board.flash.power = FOREVER;
    board.flash.handles_open = 0;
    return broke_off;
}

static void test_power_lost_at_any_write_leaves_old_or_new_settings(void)
{
    for (int harm = 0; harm < HARMS; harm++) {
        int steps = 0;
        while (save_breaks_off(steps, static_cast<harm_t>(harm))) {
            start_breaks_off(FOREVER);
            const bool old = are(own_settings());
            TEST_ASSERT_TRUE_MESSAGE(old || are(newer_settings()),
                                     std::to_string(steps).c_str());
            /* And it stays so. */
            assert_loads(DOCK_STORED_WHOLE,
                         old ? own_settings() : newer_settings());
            ++steps;
        }
        TEST_ASSERT_GREATER_THAN(SETTINGS_BLOB_BYTES, steps);
        TEST_ASSERT_EQUAL_INT(DOCK_STORED_WHOLE, load());
        TEST_ASSERT_TRUE(are(newer_settings()));
    }
}

static void test_power_lost_again_at_the_next_start_leaves_them_too(void)
{
    /* In the first place, between the two, in the second. */
    for (const int first : {2, 12, 40})
        for (int harm = 0; harm < HARMS; harm++)
            for (int steps = 0;; steps++) {
                TEST_ASSERT_TRUE(
                    save_breaks_off(first, static_cast<harm_t>(harm)));
                const bool broke_off = start_breaks_off(steps);
                start_breaks_off(FOREVER);
                TEST_ASSERT_TRUE(are(own_settings()) || are(newer_settings()));
                if (!broke_off)
                    break;
            }
}

static void test_names_fit_into_nvs(void)
{
    TEST_ASSERT_LESS_OR_EQUAL(15, strlen(NAMESPACE));
    TEST_ASSERT_LESS_OR_EQUAL(15, strlen(KEY));
}

static void run_tests(void)
{
    RUN_TEST(test_stored_settings_are_loaded_and_nothing_is_written);
    RUN_TEST(test_a_first_start_is_not_a_loss);
    RUN_TEST(test_a_partition_of_other_use_is_not_a_loss);
    RUN_TEST(test_each_flipped_bit_in_nvs_is_restored);
    RUN_TEST(test_each_flipped_bit_in_the_sector_is_written_anew);
    RUN_TEST(test_both_places_damaged_are_a_loss_and_stay_as_they_are);
    RUN_TEST(test_settings_that_once_were_there_are_a_loss);
    RUN_TEST(test_a_value_out_of_range_alone_falls_back_in_either_place);
    RUN_TEST(test_a_blob_cut_at_any_byte_is_restored);
    RUN_TEST(test_a_blob_too_long_for_any_firmware_is_restored);
    RUN_TEST(test_each_error_of_nvs_is_restored);
    RUN_TEST(test_settings_of_the_firmware_before_get_their_second_place);
    RUN_TEST(test_without_the_partition_there_is_one_place);
    RUN_TEST(test_what_is_saved_is_in_both_places);
    RUN_TEST(test_each_write_error_is_reported_and_leaves_old_or_new);
    RUN_TEST(test_power_lost_at_any_write_leaves_old_or_new_settings);
    RUN_TEST(test_power_lost_again_at_the_next_start_leaves_them_too);
    RUN_TEST(test_names_fit_into_nvs);
}

SUITE(run_tests)
