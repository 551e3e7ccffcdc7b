/* Settings as flash keeps them: a blob with version and checksum. */
#include <string.h>

#include "dockcore.h"
#include "fixture.h"
#include "suite.h"

static uint8_t blob[SETTINGS_BLOB_BYTES];

/* Every parameter away from its default. */
static dock_settings_t unusual(void)
{
    dock_settings_t settings = dock_default_settings();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        parameter_set(p, &settings,
                      p->initial == p->maximum ? p->minimum : p->maximum);
    }
    return settings;
}

static void assert_same(const dock_settings_t *a, const dock_settings_t *b)
{
    for (int i = 0; i < PARAMETER_COUNT; i++)
        TEST_ASSERT_EQUAL_INT32_MESSAGE(parameter_get(&PARAMETERS[i], a),
                                        parameter_get(&PARAMETERS[i], b),
                                        PARAMETERS[i].name);
}

static void assert_refused(const uint8_t *bytes, size_t length)
{
    const dock_settings_t before = unusual();
    dock_settings_t settings = before;
    TEST_ASSERT_FALSE(settings_from_blob(&settings, bytes, length));
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings, sizeof settings);
}

static void put32(size_t at, uint32_t value)
{
    for (size_t i = 0; i < 4; i++)
        blob[at + i] = (uint8_t)(value >> 8 * i);
}

/* CRC-32 by long division of the reflected polynomial, bit for bit. */
static void put_checksum(void)
{
    uint32_t crc = UINT32_MAX;
    for (size_t bit = 0; bit < 8 * (SETTINGS_BLOB_BYTES - 4); bit++) {
        const uint32_t in = (uint32_t)blob[bit / 8] >> bit % 8 & 1;
        const uint32_t out = (crc & 1) ^ in;
        crc = crc >> 1 ^ out * UINT32_C(0xEDB88320);
    }
    put32(SETTINGS_BLOB_BYTES - 4, ~crc);
}

static void test_settings_come_back_as_they_were(void)
{
    const dock_settings_t before = unusual();
    dock_settings_t after = dock_default_settings();
    settings_to_blob(&before, blob);
    TEST_ASSERT_TRUE(settings_from_blob(&after, blob, sizeof blob));
    assert_same(&before, &after);
}

static void test_any_settings_come_back_as_they_were(void)
{
    uint32_t state = 5;
    for (int round = 0; round < 500; round++) {
        dock_settings_t before = dock_default_settings();
        dock_settings_t after = unusual();
        for (int i = 0; i < PARAMETER_COUNT; i++) {
            const parameter_t *p = &PARAMETERS[i];
            const uint32_t range = (uint32_t)(p->maximum - p->minimum) + 1;
            const uint32_t at =
                (noise(&state) << 16 | (noise(&state) & 0xFFFF)) % range;
            TEST_ASSERT_TRUE(
                parameter_set(p, &before, p->minimum + (int32_t)at));
        }
        settings_to_blob(&before, blob);
        TEST_ASSERT_TRUE(settings_from_blob(&after, blob, sizeof blob));
        assert_same(&before, &after);
    }
}

static void test_the_checksum_is_that_of_zlib(void)
{
    const dock_settings_t settings = unusual();
    uint8_t own[sizeof blob];
    settings_to_blob(&settings, own);
    memcpy(blob, own, sizeof blob);
    put_checksum();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(blob, own, sizeof blob);
}

static void test_a_blob_with_any_bit_flipped_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    settings_to_blob(&settings, blob);
    for (size_t bit = 0; bit < 8 * sizeof blob; bit++) {
        blob[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_refused(blob, sizeof blob);
        blob[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}

static void test_a_blob_with_any_byte_inverted_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    settings_to_blob(&settings, blob);
    for (size_t i = 0; i < sizeof blob; i++) {
        blob[i] ^= 0xFF;
        assert_refused(blob, sizeof blob);
        blob[i] ^= 0xFF;
    }
}

static void test_a_blob_of_another_length_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    uint8_t longer[sizeof blob + 4] = {0};
    settings_to_blob(&settings, longer);
    for (size_t length = 0; length <= sizeof longer; length++)
        if (length != sizeof blob)
            assert_refused(longer, length);
}

static void test_an_erased_or_empty_flash_is_refused(void)
{
    memset(blob, 0xFF, sizeof blob);
    assert_refused(blob, sizeof blob);
    memset(blob, 0, sizeof blob);
    assert_refused(blob, sizeof blob);
    assert_refused(NULL, 0);
}

static void test_another_version_with_a_right_checksum_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    settings_to_blob(&settings, blob);
    put32(0, PARAMETER_TABLE_VERSION + 1);
    put_checksum();
    assert_refused(blob, sizeof blob);

    put32(0, PARAMETER_TABLE_VERSION);
    put_checksum();
    dock_settings_t read;
    TEST_ASSERT_TRUE(settings_from_blob(&read, blob, sizeof blob));
}

static void test_a_value_out_of_range_with_a_right_checksum_is_refused(void)
{
    for (size_t i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t wrong[] = {p->minimum - 1, p->maximum + 1, INT32_MAX};
        for (size_t k = 0; k < 3; k++) {
            const dock_settings_t settings = dock_default_settings();
            settings_to_blob(&settings, blob);
            put32(4 * (i + 1), (uint32_t)wrong[k]);
            put_checksum();
            assert_refused(blob, sizeof blob);
        }
    }
}

static void test_a_dock_with_invalid_settings_starts_with_the_defaults(void)
{
    static dock_t dock;
    dock_settings_t settings = unusual();
    const dock_settings_t defaults = dock_default_settings();
    settings.report_hz = 31;
    dock_init(&dock, &settings);
    assert_same(&defaults, &dock.settings);

    settings.report_hz = 30;
    dock_init(&dock, &settings);
    assert_same(&settings, &dock.settings);
}

static void run_tests(void)
{
    RUN_TEST(test_settings_come_back_as_they_were);
    RUN_TEST(test_any_settings_come_back_as_they_were);
    RUN_TEST(test_the_checksum_is_that_of_zlib);
    RUN_TEST(test_a_blob_with_any_bit_flipped_is_refused);
    RUN_TEST(test_a_blob_with_any_byte_inverted_is_refused);
    RUN_TEST(test_a_blob_of_another_length_is_refused);
    RUN_TEST(test_an_erased_or_empty_flash_is_refused);
    RUN_TEST(test_another_version_with_a_right_checksum_is_refused);
    RUN_TEST(test_a_value_out_of_range_with_a_right_checksum_is_refused);
    RUN_TEST(test_a_dock_with_invalid_settings_starts_with_the_defaults);
}

SUITE(run_tests)
