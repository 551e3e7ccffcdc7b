/* Settings as flash keeps them: entries by key, and a checksum. */
#include <string.h>

#include "../settings_of_table.h"
#include "dockcore.h"
#include "fixture.h"
#include "suite.h"

static uint8_t blob[SETTINGS_BLOB_LONGEST];
static size_t length;

/* In the flash of docks, so they must never change.  Computed by Python:
 * zlib.crc32(b"LED_ANODE" + bytes([1, 0])) and so on. */
#define KEY_EXPOSURE UINT32_C(0xeb292642)
#define KEY_FALLBACK UINT32_C(0x227a7848)
#define KEY_ANODE UINT32_C(0xb68f2e08)

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

static void assert_refused(const uint8_t *bytes, size_t n)
{
    const dock_settings_t before = unusual();
    dock_settings_t settings = before;
    TEST_ASSERT_EQUAL_INT(SETTINGS_REFUSED,
                          settings_from_blob(&settings, bytes, n));
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings, sizeof settings);
}

static void store(const dock_settings_t *settings)
{
    settings_to_blob(settings, blob);
    length = SETTINGS_BLOB_BYTES;
}

static void put(size_t at, uint32_t value)
{
    for (size_t i = 0; i < 4; i++)
        blob[at + i] = (uint8_t)(value >> 8 * i);
}

/* CRC-32 by long division of the reflected polynomial, bit for bit. */
static void put_checksum(void)
{
    uint32_t crc = UINT32_MAX;
    for (size_t bit = 0; bit < 8 * (length - 4); bit++) {
        const uint32_t in = (uint32_t)blob[bit / 8] >> bit % 8 & 1;
        const uint32_t out = (crc & 1) ^ in;
        crc = crc >> 1 ^ out * UINT32_C(0xEDB88320);
    }
    put(length - 4, ~crc);
}

typedef struct {
    uint32_t key, value;
} entry_t;

/* A blob with `count` entries of keys and values, as any firmware could have
 * written it. */
static void store_entries(const entry_t *entries, size_t count)
{
    put(0, SETTINGS_BLOB_FORMAT);
    put(4, (uint32_t)count);
    for (size_t i = 0; i < count; i++) {
        put(8 + 8 * i, entries[i].key);
        put(12 + 8 * i, entries[i].value);
    }
    length = 8 + 8 * count + 4;
    put_checksum();
}

static void assert_reads(settings_read_t result,
                         const dock_settings_t *expected)
{
    dock_settings_t settings = unusual();
    TEST_ASSERT_EQUAL_INT(result, settings_from_blob(&settings, blob, length));
    assert_same(expected, &settings);
}

static void test_settings_come_back_as_they_were(void)
{
    const dock_settings_t before = unusual();
    dock_settings_t after = dock_default_settings();
    store(&before);
    TEST_ASSERT_EQUAL_INT(SETTINGS_READ,
                          settings_from_blob(&after, blob, length));
    assert_same(&before, &after);
}

static void test_any_settings_come_back_as_they_were(void)
{
    uint32_t state = 5;
    for (int round = 0; round < 500; round++) {
        dock_settings_t before = dock_default_settings();
        for (int i = 0; i < PARAMETER_COUNT; i++) {
            const parameter_t *p = &PARAMETERS[i];
            const uint32_t range = (uint32_t)(p->maximum - p->minimum) + 1;
            const uint32_t at =
                (noise(&state) << 16 | (noise(&state) & 0xFFFF)) % range;
            TEST_ASSERT_TRUE(
                parameter_set(p, &before, p->minimum + (int32_t)at));
        }
        store(&before);
        assert_reads(SETTINGS_READ, &before);
    }
}

static void test_the_checksum_is_that_of_zlib(void)
{
    const dock_settings_t settings = unusual();
    uint8_t own[SETTINGS_BLOB_BYTES];
    settings_to_blob(&settings, own);
    store(&settings);
    put_checksum();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(blob, own, sizeof own);
}

static void test_the_keys_are_what_they_always_were(void)
{
    TEST_ASSERT_EQUAL_HEX32(KEY_ANODE,
                            settings_key(&PARAMETERS[PARAMETER_LED_ANODE]));
    TEST_ASSERT_EQUAL_HEX32(KEY_FALLBACK,
                            settings_key(&PARAMETERS[PARAMETER_FALLBACK_HUE]));
    TEST_ASSERT_EQUAL_HEX32(KEY_EXPOSURE,
                            settings_key(&PARAMETERS[PARAMETER_CAM_EXPOSURE]));
}

static void test_no_two_parameters_have_one_key(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++)
        for (int j = 0; j < i; j++)
            TEST_ASSERT_TRUE(settings_key(&PARAMETERS[i]) !=
                             settings_key(&PARAMETERS[j]));
}

static void test_another_scale_is_another_key(void)
{
    parameter_t scaled = PARAMETERS[PARAMETER_WINDOW_MS];
    scaled.numerator = 10;
    TEST_ASSERT_TRUE(settings_key(&PARAMETERS[PARAMETER_WINDOW_MS]) !=
                     settings_key(&scaled));
}

static void test_settings_of_firmware_with_fewer_parameters_are_read(void)
{
    const entry_t entries[] = {{KEY_EXPOSURE, 321}, {KEY_ANODE, 1}};
    dock_settings_t expected = dock_default_settings();
    expected.camera.exposure = 321;
    expected.led.common_anode = true;

    store_entries(entries, 2);

    assert_reads(SETTINGS_READ, &expected);
}

static void test_settings_of_firmware_with_more_parameters_are_read(void)
{
    const entry_t entries[] = {
        {0x12345678, 99}, {KEY_EXPOSURE, 321}, {0, UINT32_MAX}, {KEY_ANODE, 1}};
    dock_settings_t expected = dock_default_settings();
    expected.camera.exposure = 321;
    expected.led.common_anode = true;

    store_entries(entries, 4);

    assert_reads(SETTINGS_READ, &expected);
}

static void test_a_blob_as_long_as_can_be_is_read(void)
{
    static entry_t entries[(SETTINGS_BLOB_LONGEST - 12) / 8];
    const size_t count = sizeof entries / sizeof entries[0];
    entries[count - 1].key = KEY_EXPOSURE;
    entries[count - 1].value = 321;
    dock_settings_t expected = dock_default_settings();
    expected.camera.exposure = 321;

    store_entries(entries, count);

    assert_reads(SETTINGS_READ, &expected);
}

static void test_a_value_out_of_range_alone_falls_back(void)
{
    const dock_settings_t others = unusual();
    for (size_t i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t wrong[] = {p->minimum - 1, p->maximum + 1, INT32_MAX};
        dock_settings_t expected = others;
        parameter_set(p, &expected, p->initial);
        for (size_t k = 0; k < 3; k++) {
            store(&others);
            put(12 + 8 * i, (uint32_t)wrong[k]);
            put_checksum();
            assert_reads(SETTINGS_MENDED, &expected);
        }
    }
}

static void test_a_blob_with_any_bit_flipped_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    store(&settings);
    for (size_t bit = 0; bit < 8 * length; bit++) {
        blob[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_refused(blob, length);
        blob[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}

static void test_a_blob_with_any_byte_inverted_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    store(&settings);
    for (size_t i = 0; i < length; i++) {
        blob[i] ^= 0xFF;
        assert_refused(blob, length);
        blob[i] ^= 0xFF;
    }
}

static void test_a_blob_cut_or_lengthened_anywhere_is_refused(void)
{
    const dock_settings_t settings = unusual();
    store(&settings);
    for (size_t n = 0; n <= sizeof blob; n++)
        if (n != length)
            assert_refused(blob, n);
}

static void test_an_erased_or_empty_flash_is_refused(void)
{
    for (size_t n = 0; n <= sizeof blob; n++) {
        memset(blob, 0xFF, sizeof blob);
        assert_refused(blob, n);
        memset(blob, 0, sizeof blob);
        assert_refused(blob, n);
    }
    assert_refused(NULL, 0);
}

static void test_another_format_with_a_right_checksum_is_refused(void)
{
    const dock_settings_t settings = dock_default_settings();
    store(&settings);
    put(0, SETTINGS_BLOB_FORMAT + 1);
    put_checksum();
    assert_refused(blob, length);
}

/* The stored values that it was given. */
static const struct {
    int parameter;
    int32_t value;
} IN_TABLE[] = {
    {PARAMETER_MAPPING, 2},         {PARAMETER_WINDOW_MS, 330},
    {PARAMETER_FALLBACK_HUE, 232},  {PARAMETER_LED_MODE, 1},
    {PARAMETER_LED_HUE, 325},       {PARAMETER_LED_OFFSET_R, -132},
    {PARAMETER_LED_OFFSET_G, -116}, {PARAMETER_LED_OFFSET_B, -101},
    {PARAMETER_LED_M_RR, -10923},   {PARAMETER_LED_M_RG, -8938},
    {PARAMETER_LED_M_RB, -6952},    {PARAMETER_LED_M_GR, -4966},
    {PARAMETER_LED_M_GG, -2980},    {PARAMETER_LED_M_GB, -994},
    {PARAMETER_LED_M_BR, 992},      {PARAMETER_LED_M_BG, 2978},
    {PARAMETER_LED_M_BB, 4964},     {PARAMETER_LED_GAMMA, 3},
    {PARAMETER_LED_LIMIT, 162},     {PARAMETER_LED_ANODE, 0},
    {PARAMETER_CAM_LOCK, 0},        {PARAMETER_CAM_EXPOSURE, 872},
    {PARAMETER_CAM_GAIN, 30},       {PARAMETER_CAM_WB, 4},
    {PARAMETER_REPORT_HZ, 0},       {PARAMETER_LINK_BAUD, 783418},
};

static void test_settings_of_the_firmware_before_are_read(void)
{
    dock_settings_t settings = dock_default_settings();

    TEST_ASSERT_EQUAL_INT(SETTINGS_READ, settings_from_blob(&settings, OF_TABLE,
                                                            sizeof OF_TABLE));

    for (size_t i = 0; i < sizeof IN_TABLE / sizeof IN_TABLE[0]; i++)
        TEST_ASSERT_EQUAL_INT32_MESSAGE(
            IN_TABLE[i].value,
            parameter_get(&PARAMETERS[IN_TABLE[i].parameter], &settings),
            PARAMETERS[IN_TABLE[i].parameter].name);
}

static void test_damaged_settings_of_the_firmware_before_are_refused(void)
{
    for (size_t n = 0; n < sizeof OF_TABLE; n++)
        assert_refused(OF_TABLE, n);
    memcpy(blob, OF_TABLE, sizeof OF_TABLE);
    for (size_t bit = 0; bit < 8 * sizeof OF_TABLE; bit++) {
        blob[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_refused(blob, sizeof OF_TABLE);
        blob[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}

static void test_a_bad_value_of_the_firmware_before_alone_falls_back(void)
{
    memcpy(blob, OF_TABLE, sizeof OF_TABLE);
    length = sizeof OF_TABLE;
    dock_settings_t expected;
    settings_from_blob(&expected, blob, length);
    expected.led.limit = 255;
    put(4 + 4 * 18, 256); /* LED_LIMIT */
    put_checksum();

    assert_reads(SETTINGS_MENDED, &expected);
}

static void test_a_dock_mends_what_is_out_of_range_alone(void)
{
    static dock_t dock;
    dock_settings_t settings = unusual();
    dock_settings_t expected = settings;
    settings.report_hz = 31;
    expected.report_hz = 5;
    dock_init(&dock, &settings);
    assert_same(&expected, &dock.settings);

    settings.report_hz = 30;
    dock_init(&dock, &settings);
    assert_same(&settings, &dock.settings);
}

static void test_a_reset_leaves_what_belongs_to_the_wiring(void)
{
    const dock_settings_t before = unusual();
    dock_settings_t expected = dock_default_settings();
    expected.led.limit = 0;
    expected.led.common_anode = true;

    const dock_settings_t after = dock_reset_settings(&before);

    assert_same(&expected, &after);
}

/* What a dock with MOSFETs must have when nothing is known: low pins. */
static void test_the_default_polarity_is_dark_where_mosfets_are(void)
{
    const dock_settings_t settings = dock_default_settings();
    uint16_t duty[3];
    led_dark(duty, &settings.led);
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_UINT16(0, duty[i]);
}

static void run_tests(void)
{
    RUN_TEST(test_settings_come_back_as_they_were);
    RUN_TEST(test_any_settings_come_back_as_they_were);
    RUN_TEST(test_the_checksum_is_that_of_zlib);
    RUN_TEST(test_the_keys_are_what_they_always_were);
    RUN_TEST(test_no_two_parameters_have_one_key);
    RUN_TEST(test_another_scale_is_another_key);
    RUN_TEST(test_settings_of_firmware_with_fewer_parameters_are_read);
    RUN_TEST(test_settings_of_firmware_with_more_parameters_are_read);
    RUN_TEST(test_a_blob_as_long_as_can_be_is_read);
    RUN_TEST(test_a_value_out_of_range_alone_falls_back);
    RUN_TEST(test_a_blob_with_any_bit_flipped_is_refused);
    RUN_TEST(test_a_blob_with_any_byte_inverted_is_refused);
    RUN_TEST(test_a_blob_cut_or_lengthened_anywhere_is_refused);
    RUN_TEST(test_an_erased_or_empty_flash_is_refused);
    RUN_TEST(test_another_format_with_a_right_checksum_is_refused);
    RUN_TEST(test_settings_of_the_firmware_before_are_read);
    RUN_TEST(test_damaged_settings_of_the_firmware_before_are_refused);
    RUN_TEST(test_a_bad_value_of_the_firmware_before_alone_falls_back);
    RUN_TEST(test_a_dock_mends_what_is_out_of_range_alone);
    RUN_TEST(test_a_reset_leaves_what_belongs_to_the_wiring);
    RUN_TEST(test_the_default_polarity_is_dark_where_mosfets_are);
}

SUITE(run_tests)
