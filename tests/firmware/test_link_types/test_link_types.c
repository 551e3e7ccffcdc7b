/* PARAM_SET as different hosts write it: cast to a float, or an integer's own
 * bytes with its type. */
#include <string.h>

#include "link_fixture.h"
#include "suite.h"

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float shown(const parameter_t *p, int32_t stored)
{
    return (float)stored * (float)p->numerator / (float)(1u << p->shift);
}

static bool is_whole(const parameter_t *p)
{
    return p->shift == 0;
}

/* Every type, its width and whether it has a sign, by MAVLink's definition. */
static const struct {
    uint8_t type;
    int bits;
    bool has_sign;
} integers[] = {
    {MAV_PARAM_TYPE_UINT8, 8, false},   {MAV_PARAM_TYPE_INT8, 8, true},
    {MAV_PARAM_TYPE_UINT16, 16, false}, {MAV_PARAM_TYPE_INT16, 16, true},
    {MAV_PARAM_TYPE_UINT32, 32, false}, {MAV_PARAM_TYPE_INT32, 32, true},
};

static bool holds(size_t kind, int32_t value)
{
    const int64_t span = INT64_C(1) << integers[kind].bits;
    return integers[kind].has_sign ? value >= -span / 2 && value < span / 2
                                   : value >= 0 && value < span;
}

static void assert_set(const parameter_t *p, uint32_t bits, uint8_t type,
                       int32_t stored)
{
    tell(wire_parameter_bits(p->name, bits, type));
    TEST_ASSERT_EQUAL_INT32_MESSAGE(stored, parameter_get(p, &dock.settings),
                                    p->name);
    assert_value(p->name, shown(p, stored));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, heard_count(MAVLINK_MSG_ID_STATUSTEXT),
                                   p->name);
}

static const int32_t *ends_of(const parameter_t *p)
{
    static int32_t ends[4];
    ends[0] = p->maximum;
    ends[1] = p->minimum;
    ends[2] = p->minimum + (p->maximum - p->minimum) / 3;
    ends[3] = p->initial;
    return ends;
}

static void test_an_integers_bytes_are_that_integer(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++)
        for (size_t kind = 0; kind < 6; kind++)
            for (int k = 0; k < 4; k++) {
                const parameter_t *p = &PARAMETERS[i];
                const int32_t value = ends_of(p)[k];
                if (!is_whole(p) || !holds(kind, value))
                    continue;
                assert_set(p, (uint32_t)value, integers[kind].type, value);
                /* Not extended by the sign, as unions are filled. */
                if (integers[kind].bits < 32)
                    assert_set(
                        p, (uint32_t)value & ((1u << integers[kind].bits) - 1),
                        integers[kind].type, value);
            }
}

static void test_an_integer_type_with_a_floats_value_is_that_value(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++)
        for (uint8_t type = 0; type <= MAV_PARAM_TYPE_REAL64; type++)
            for (int k = 0; k < 4; k++) {
                const parameter_t *p = &PARAMETERS[i];
                const int32_t value = ends_of(p)[k];
                assert_set(p, bits_of(shown(p, value)), type, value);
            }
}

/* What makes the two distinguishable. */
static void test_no_whole_parameter_reaches_what_a_float_might_be(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        TEST_ASSERT_LESS_THAN_INT32(1 << 23, PARAMETERS[i].maximum);
        TEST_ASSERT_GREATER_THAN_INT32(-(1 << 23), PARAMETERS[i].minimum);
    }
}

static void test_an_integers_bytes_as_a_float_are_refused_in_words(void)
{
    link_start();
    const dock_settings_t before = dock.settings;
    static const uint8_t types[] = {MAV_PARAM_TYPE_REAL32, 0,
                                    MAV_PARAM_TYPE_INT64};
    for (size_t i = 0; i < 3; i++) {
        tell(wire_parameter_bits("LED_LIMIT", 128, types[i]));
        assert_text(MAV_SEVERITY_WARNING,
                    "LED_LIMIT refused: allowed 0 to 255");
        TEST_ASSERT_EQUAL_MEMORY(&before, &dock.settings, sizeof before);
    }
}

static void test_bytes_out_of_range_are_refused(void)
{
    link_start();
    tell(wire_parameter_bits("LED_LIMIT", 256, MAV_PARAM_TYPE_INT32));
    assert_text(MAV_SEVERITY_WARNING, "LED_LIMIT refused: allowed 0 to 255");
    tell(wire_parameter_bits("CAM_GAIN", (uint32_t)-2, MAV_PARAM_TYPE_INT8));
    assert_text(MAV_SEVERITY_WARNING, "CAM_GAIN refused: allowed -1 to 30");
}

/* A fraction has no integer type; whole degrees do. */
static void test_whole_degrees_as_bytes_are_degrees(void)
{
    link_start();
    tell(wire_parameter_bits("LED_HUE", 120, MAV_PARAM_TYPE_INT32));
    assert_value("LED_HUE", 120);
}

static void run_tests(void)
{
    RUN_TEST(test_an_integers_bytes_are_that_integer);
    RUN_TEST(test_an_integer_type_with_a_floats_value_is_that_value);
    RUN_TEST(test_no_whole_parameter_reaches_what_a_float_might_be);
    RUN_TEST(test_an_integers_bytes_as_a_float_are_refused_in_words);
    RUN_TEST(test_bytes_out_of_range_are_refused);
    RUN_TEST(test_whole_degrees_as_bytes_are_degrees);
}

SUITE(run_tests)
