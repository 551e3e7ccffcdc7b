/* Every parameter of the table: where it lives, its range, its number. */
#include <string.h>

#include "dockcore.h"
#include "suite.h"

static uint32_t bits_of(double value)
{
    const float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return bits;
}

static double shown(const parameter_t *p, int32_t stored)
{
    return (double)stored * p->numerator / (double)(UINT64_C(1) << p->shift);
}

static dock_settings_t away_from_the_defaults(void)
{
    dock_settings_t settings = dock_default_settings();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        parameter_set(p, &settings,
                      p->initial == p->maximum ? p->minimum : p->maximum);
    }
    return settings;
}

/* In steps that reach both ends; every value of all but the baud rate. */
#define FOR_EACH_VALUE(p, value)                              \
    for (int32_t value = (p)->minimum; value <= (p)->maximum; \
         value += (p)->maximum - value > 70000 ? 31 : 1)

static void test_each_name_is_different_and_fits(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const size_t length = strlen(PARAMETERS[i].name);
        TEST_ASSERT_GREATER_THAN_UINT(0, length);
        TEST_ASSERT_LESS_THAN_UINT(16, length);
        for (int j = 0; j < i; j++)
            TEST_ASSERT_TRUE(strcmp(PARAMETERS[i].name, PARAMETERS[j].name));
    }
}

static void
test_the_defaults_are_in_range_and_what_the_settings_start_with(void)
{
    const dock_settings_t settings = dock_default_settings();
    dock_settings_t copy = settings;
    TEST_ASSERT_EQUAL_INT(0, dock_mend_settings(&copy));
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        TEST_ASSERT_TRUE(p->minimum <= p->initial && p->initial <= p->maximum);
        TEST_ASSERT_EQUAL_INT32_MESSAGE(p->initial, parameter_get(p, &settings),
                                        p->name);
    }
}

static void test_some_defaults_are_where_the_code_looks_for_them(void)
{
    const dock_settings_t settings = dock_default_settings();
    TEST_ASSERT_EQUAL_UINT16(2000, settings.window_ms);
    TEST_ASSERT_EQUAL_UINT16(512, settings.fallback_hue);
    TEST_ASSERT_EQUAL_INT16(4096, settings.led.matrix[0]);
    TEST_ASSERT_EQUAL_INT16(0, settings.led.matrix[1]);
    TEST_ASSERT_EQUAL_INT16(4096, settings.led.matrix[8]);
    TEST_ASSERT_FALSE(settings.led.common_anode);
    TEST_ASSERT_EQUAL_INT8(-1, settings.camera.gain);
    TEST_ASSERT_EQUAL_UINT32(921600, settings.link_baud);
}

static void test_each_value_in_range_is_kept(void)
{
    dock_settings_t settings = dock_default_settings();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        FOR_EACH_VALUE(p, value)
        {
            TEST_ASSERT_TRUE(parameter_set(p, &settings, value));
            TEST_ASSERT_EQUAL_INT32(value, parameter_get(p, &settings));
            TEST_ASSERT_EQUAL_INT(0, dock_mend_settings(&settings));
        }
    }
}

static void test_setting_one_leaves_all_others(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        dock_settings_t settings = dock_default_settings();
        const parameter_t *set = &PARAMETERS[i];
        const int32_t value =
            set->initial == set->minimum ? set->maximum : set->minimum;
        TEST_ASSERT_TRUE(parameter_set(set, &settings, value));
        for (int j = 0; j < PARAMETER_COUNT; j++)
            TEST_ASSERT_EQUAL_INT32_MESSAGE(
                j == i ? value : PARAMETERS[j].initial,
                parameter_get(&PARAMETERS[j], &settings), PARAMETERS[j].name);
    }
}

static void test_a_value_out_of_range_changes_nothing(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t wrong[] = {p->minimum - 1, p->maximum + 1, INT32_MIN,
                                 INT32_MAX};
        const dock_settings_t before = dock_default_settings();
        dock_settings_t settings = before;
        for (size_t k = 0; k < 4; k++) {
            TEST_ASSERT_FALSE_MESSAGE(parameter_set(p, &settings, wrong[k]),
                                      p->name);
            TEST_ASSERT_EQUAL_MEMORY(&before, &settings, sizeof settings);
        }
    }
}

static void test_a_field_out_of_range_becomes_its_default_alone(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t top = p->size == 4     ? INT32_MAX
                            : p->minimum < 0 ? (1 << (8 * p->size - 1)) - 1
                                             : (1 << 8 * p->size) - 1;
        if (top == p->maximum) /* the field cannot hold more */
            continue;
        dock_settings_t expected = away_from_the_defaults();
        dock_settings_t settings = expected;
        parameter_set(p, &expected, p->initial);
        uint8_t *at = (uint8_t *)&settings + p->offset;
        for (int k = 0; k < p->size; k++)
            at[k] = (uint8_t)((uint32_t)(p->maximum + 1) >> 8 * k);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, dock_mend_settings(&settings),
                                      p->name);
        for (int j = 0; j < PARAMETER_COUNT; j++)
            TEST_ASSERT_EQUAL_INT32_MESSAGE(
                parameter_get(&PARAMETERS[j], &expected),
                parameter_get(&PARAMETERS[j], &settings), PARAMETERS[j].name);
    }
}

static void test_each_value_travels_as_the_compilers_float(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        FOR_EACH_VALUE(p, value)
        {
            const uint32_t bits = parameter_to_real32(p, value);
            int32_t back = 0;
            TEST_ASSERT_EQUAL_HEX32(bits_of(shown(p, value)), bits);
            TEST_ASSERT_TRUE(parameter_from_real32(p, bits, &back));
            TEST_ASSERT_EQUAL_INT32_MESSAGE(value, back, p->name);
        }
    }
}

/* A little less and a little more than half a step away from a value. */
static void test_a_number_goes_to_the_nearest_value(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const double step = shown(p, 1);
        for (int32_t value = -100; value <= 100; value++) {
            const double at = shown(p, value);
            int32_t n;
            TEST_ASSERT_TRUE(
                parameter_from_real32(p, bits_of(at + 0.4999 * step), &n));
            TEST_ASSERT_EQUAL_INT32_MESSAGE(value, n, p->name);
            TEST_ASSERT_TRUE(
                parameter_from_real32(p, bits_of(at + 0.5001 * step), &n));
            TEST_ASSERT_EQUAL_INT32_MESSAGE(value + 1, n, p->name);
        }
    }
}

static void test_what_is_no_number_is_refused(void)
{
    static const uint32_t wrong[] = {0x7FC00000,
                                     0xFFC00000,
                                     0x7F800000,
                                     0xFF800000,
                                     0x7F7FFFFF,
                                     0xFF7FFFFF,
                                     0x4F800000 /* 2^32 */,
                                     0xCF800000};
    for (int i = 0; i < PARAMETER_COUNT; i++)
        for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
            int32_t stored = 77;
            TEST_ASSERT_FALSE(
                parameter_from_real32(&PARAMETERS[i], wrong[k], &stored));
            TEST_ASSERT_EQUAL_INT32(77, stored);
        }
}

static void run_tests(void)
{
    RUN_TEST(test_each_name_is_different_and_fits);
    RUN_TEST(test_the_defaults_are_in_range_and_what_the_settings_start_with);
    RUN_TEST(test_some_defaults_are_where_the_code_looks_for_them);
    RUN_TEST(test_each_value_in_range_is_kept);
    RUN_TEST(test_setting_one_leaves_all_others);
    RUN_TEST(test_a_value_out_of_range_changes_nothing);
    RUN_TEST(test_a_field_out_of_range_becomes_its_default_alone);
    RUN_TEST(test_each_value_travels_as_the_compilers_float);
    RUN_TEST(test_a_number_goes_to_the_nearest_value);
    RUN_TEST(test_what_is_no_number_is_refused);
}

SUITE(run_tests)
