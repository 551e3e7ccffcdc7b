/* PARAM_SET as different hosts write it: cast to a float, or an integer's own
 * bytes with its type; and in which of the two each of them is answered. */
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

static bool is_integer(uint8_t type)
{
    return type >= MAV_PARAM_TYPE_UINT8 && type <= MAV_PARAM_TYPE_INT32;
}

/* A value that travels as a float is answered as one, an integer's own bytes by
 * such bytes; zero's bytes are the same, its type tells. */
static void assert_set(const parameter_t *p, uint32_t bits, uint8_t type,
                       int32_t stored)
{
    const bool is_float =
        bits == bits_of(shown(p, stored)) && !(bits == 0 && is_integer(type));
    tell(wire_parameter_bits(p->name, bits, type));
    TEST_ASSERT_EQUAL_INT32_MESSAGE(stored, parameter_get(p, &dock.settings),
                                    p->name);
    if (is_float || !is_whole(p))
        assert_value(p->name, shown(p, stored));
    else
        assert_whole(p->name, stored);
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

static void test_a_refused_set_is_answered_in_its_own_way(void)
{
    link_start();
    tell(wire_parameter_bits("LED_LIMIT", 256, MAV_PARAM_TYPE_INT32));
    assert_whole("LED_LIMIT", 255);
    tell(wire_parameter_bits("LED_LIMIT", bits_of(256), MAV_PARAM_TYPE_INT32));
    assert_value("LED_LIMIT", 255);
    tell(wire_parameter_bits("LED_LIMIT", 128, MAV_PARAM_TYPE_REAL32));
    assert_value("LED_LIMIT", 255);
}

static void test_whoever_set_bytes_reads_floats_all_the_same(void)
{
    link_start();
    tell(wire_parameter_bits("LED_LIMIT", 7, MAV_PARAM_TYPE_INT32));
    assert_whole("LED_LIMIT", 7);
    tell(wire_parameter_read("LED_LIMIT", -1));
    assert_value("LED_LIMIT", 7);
}

#define MAVSDK 245

/* The types of a list of all parameters, by index. */
static void list_types(uint8_t types[PARAMETER_COUNT])
{
    tell(wire_parameter_list());
    hear();
    TEST_ASSERT_EQUAL_UINT(PARAMETER_COUNT,
                           heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
    memset(types, 0, PARAMETER_COUNT);
    for (size_t i = 0; i < PARAMETER_COUNT; i++) {
        mavlink_param_value_t value;
        mavlink_msg_param_value_decode(heard(MAVLINK_MSG_ID_PARAM_VALUE, i),
                                       &value);
        TEST_ASSERT_LESS_THAN_UINT(PARAMETER_COUNT, value.param_index);
        types[value.param_index] = value.param_type;
    }
}

static void test_mavsdk_reads_whole_parameters_as_integers(void)
{
    uint8_t types[PARAMETER_COUNT];
    link_start();
    host.system = MAVSDK;
    list_types(types);
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        TEST_ASSERT_EQUAL_UINT8(is_whole(p) ? MAV_PARAM_TYPE_INT32
                                            : MAV_PARAM_TYPE_REAL32,
                                types[i]);
        tell(wire_parameter_read(p->name, -1));
        if (is_whole(p))
            assert_whole(p->name, p->initial);
        else
            assert_value(p->name, shown(p, p->initial));
    }
}

static void test_mavsdk_reads_as_a_float_what_it_set_as_one(void)
{
    uint8_t types[PARAMETER_COUNT];
    link_start();
    host.system = MAVSDK;
    tell(wire_parameter_set("LED_LIMIT", 90));
    assert_value("LED_LIMIT", 90);
    tell(wire_parameter_read("LED_LIMIT", -1));
    assert_value("LED_LIMIT", 90);
    list_types(types);
    TEST_ASSERT_EQUAL_UINT8(MAV_PARAM_TYPE_REAL32, types[PARAMETER_LED_LIMIT]);
    TEST_ASSERT_EQUAL_UINT8(MAV_PARAM_TYPE_INT32, types[PARAMETER_WINDOW_MS]);

    tell(wire_parameter_bits("LED_LIMIT", 80, MAV_PARAM_TYPE_INT32));
    assert_whole("LED_LIMIT", 80);
    tell(wire_parameter_read("LED_LIMIT", -1));
    assert_whole("LED_LIMIT", 80);
}

static void test_others_read_floats_whatever_mavsdk_does(void)
{
    uint8_t types[PARAMETER_COUNT];
    link_start();
    host.system = MAVSDK;
    tell(wire_parameter_bits("LED_LIMIT", 80, MAV_PARAM_TYPE_INT32));
    assert_whole("LED_LIMIT", 80);
    host.system = 255;
    list_types(types);
    for (int i = 0; i < PARAMETER_COUNT; i++)
        TEST_ASSERT_EQUAL_UINT8(MAV_PARAM_TYPE_REAL32, types[i]);
    tell(wire_parameter_set("WINDOW_MS", 700));
    assert_value("WINDOW_MS", 700);
    host.system = MAVSDK;
    tell(wire_parameter_read("WINDOW_MS", -1));
    assert_whole("WINDOW_MS", 700);
}

static void run_tests(void)
{
    RUN_TEST(test_an_integers_bytes_are_that_integer);
    RUN_TEST(test_an_integer_type_with_a_floats_value_is_that_value);
    RUN_TEST(test_no_whole_parameter_reaches_what_a_float_might_be);
    RUN_TEST(test_an_integers_bytes_as_a_float_are_refused_in_words);
    RUN_TEST(test_bytes_out_of_range_are_refused);
    RUN_TEST(test_whole_degrees_as_bytes_are_degrees);
    RUN_TEST(test_a_refused_set_is_answered_in_its_own_way);
    RUN_TEST(test_whoever_set_bytes_reads_floats_all_the_same);
    RUN_TEST(test_mavsdk_reads_whole_parameters_as_integers);
    RUN_TEST(test_mavsdk_reads_as_a_float_what_it_set_as_one);
    RUN_TEST(test_others_read_floats_whatever_mavsdk_does);
}

SUITE(run_tests)
