/* The extended parameter protocol: each value with its own type. */
#include <string.h>

#include "link_fixture.h"
#include "suite.h"

static float shown(const parameter_t *p, int32_t stored)
{
    return (float)stored * (float)p->numerator / (float)(1u << p->shift);
}

static bool is_whole(const parameter_t *p)
{
    return p->shift == 0;
}

static void tell_message(const mavlink_message_t *message)
{
    tell(wire_of(message));
}

static void list(void)
{
    mavlink_message_t message;
    mavlink_msg_param_ext_request_list_pack(host.system, host.component,
                                            &message, host.target_system,
                                            host.target_component);
    tell_message(&message);
}

static void ask(const char *name, int16_t index)
{
    mavlink_message_t message;
    char id[17] = {0};
    strncpy(id, name, 16);
    mavlink_msg_param_ext_request_read_pack(host.system, host.component,
                                            &message, host.target_system,
                                            host.target_component, id, index);
    tell_message(&message);
}

static void set_bytes(const char *name, const void *bytes, size_t n,
                      uint8_t type)
{
    mavlink_message_t message;
    char id[17] = {0}, value[128] = {0};
    strncpy(id, name, 16);
    memcpy(value, bytes, n);
    mavlink_msg_param_ext_set_pack(host.system, host.component, &message,
                                   host.target_system, host.target_component,
                                   id, value, type);
    tell_message(&message);
}

static void set_integer(const char *name, int32_t value, uint8_t type)
{
    set_bytes(name, &value, sizeof value, type);
}

static void assert_answer(const char *name, uint8_t result, int32_t value)
{
    mavlink_param_ext_ack_t ack;
    int32_t told;
    hear();
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_PARAM_EXT_ACK));
    mavlink_msg_param_ext_ack_decode(heard(MAVLINK_MSG_ID_PARAM_EXT_ACK, 0),
                                     &ack);
    memcpy(&told, ack.param_value, sizeof told);
    TEST_ASSERT_EQUAL_STRING_LEN(name, ack.param_id, 16);
    TEST_ASSERT_EQUAL_UINT8(result, ack.param_result);
    TEST_ASSERT_EQUAL_UINT8(MAV_PARAM_EXT_TYPE_INT32, ack.param_type);
    TEST_ASSERT_EQUAL_INT32(value, told);
}

static void test_the_list_has_each_value_with_its_type(void)
{
    link_start();
    list();
    hear();
    TEST_ASSERT_EQUAL_UINT(PARAMETER_COUNT,
                           heard_count(MAVLINK_MSG_ID_PARAM_EXT_VALUE));
    for (uint16_t i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        mavlink_param_ext_value_t value;
        mavlink_msg_param_ext_value_decode(
            heard(MAVLINK_MSG_ID_PARAM_EXT_VALUE, i), &value);
        TEST_ASSERT_EQUAL_UINT16(i, value.param_index);
        TEST_ASSERT_EQUAL_UINT16(PARAMETER_COUNT, value.param_count);
        TEST_ASSERT_EQUAL_STRING_LEN(p->name, value.param_id, 16);
        const float real = shown(p, p->initial);
        if (is_whole(p)) {
            TEST_ASSERT_EQUAL_UINT8(MAV_PARAM_EXT_TYPE_INT32, value.param_type);
            TEST_ASSERT_EQUAL_MEMORY(&p->initial, value.param_value, 4);
        } else {
            TEST_ASSERT_EQUAL_UINT8(MAV_PARAM_EXT_TYPE_REAL32,
                                    value.param_type);
            TEST_ASSERT_EQUAL_MEMORY(&real, value.param_value, 4);
        }
    }
    assert_silent();
}

static void test_one_is_read_by_name_and_by_index(void)
{
    mavlink_param_ext_value_t value;
    link_start();
    for (int round = 0; round < 2; round++) {
        if (round == 0)
            ask("LED_LIMIT", -1);
        else
            ask("", PARAMETER_LED_LIMIT);
        hear();
        TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_PARAM_EXT_VALUE));
        mavlink_msg_param_ext_value_decode(
            heard(MAVLINK_MSG_ID_PARAM_EXT_VALUE, 0), &value);
        TEST_ASSERT_EQUAL_UINT16(PARAMETER_LED_LIMIT, value.param_index);
    }
    ask("NONE", -1);
    assert_text(MAV_SEVERITY_WARNING, "NONE: no such parameter");
    ask("", PARAMETER_COUNT);
    hear();
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_PARAM_EXT_VALUE));
    TEST_ASSERT_EQUAL_UINT32(0, status_now().link_faults);
}

static void test_each_is_set_to_both_ends(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t ends[] = {p->maximum, p->minimum};
        for (int k = 0; k < 2; k++) {
            const float real = shown(p, ends[k]);
            if (is_whole(p))
                set_integer(p->name, ends[k], MAV_PARAM_EXT_TYPE_INT32);
            else
                set_bytes(p->name, &real, 4, MAV_PARAM_EXT_TYPE_REAL32);
            TEST_ASSERT_EQUAL_INT32_MESSAGE(
                ends[k], parameter_get(p, &dock.settings), p->name);
            hear();
            TEST_ASSERT_EQUAL_UINT(1,
                                   heard_count(MAVLINK_MSG_ID_PARAM_EXT_ACK));
            TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
        }
    }
}

static void test_every_integer_type_and_a_float_are_read(void)
{
    static const uint8_t types[] = {
        MAV_PARAM_EXT_TYPE_UINT8,  MAV_PARAM_EXT_TYPE_INT8,
        MAV_PARAM_EXT_TYPE_UINT16, MAV_PARAM_EXT_TYPE_INT16,
        MAV_PARAM_EXT_TYPE_UINT32, MAV_PARAM_EXT_TYPE_INT32};
    const float real = 33;
    link_start();
    for (int i = 0; i < 6; i++) {
        set_integer("LED_LIMIT", 20 + i, types[i]);
        assert_answer("LED_LIMIT", PARAM_ACK_ACCEPTED, 20 + i);
    }
    set_bytes("LED_LIMIT", &real, 4, MAV_PARAM_EXT_TYPE_REAL32);
    assert_answer("LED_LIMIT", PARAM_ACK_ACCEPTED, 33);
    set_integer("CAM_GAIN", -1, MAV_PARAM_EXT_TYPE_INT8);
    assert_answer("CAM_GAIN", PARAM_ACK_ACCEPTED, -1);
}

static void test_what_is_refused_is_answered_with_the_value_as_it_is(void)
{
    link_start();
    set_integer("LED_LIMIT", 7, MAV_PARAM_EXT_TYPE_INT32);
    assert_answer("LED_LIMIT", PARAM_ACK_ACCEPTED, 7);
    set_integer("LED_LIMIT", 300, MAV_PARAM_EXT_TYPE_INT32);
    assert_answer("LED_LIMIT", PARAM_ACK_VALUE_UNSUPPORTED, 7);
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    set_integer("LED_LIMIT", 9, MAV_PARAM_EXT_TYPE_INT64);
    assert_answer("LED_LIMIT", PARAM_ACK_VALUE_UNSUPPORTED, 7);
    set_bytes("LED_LIMIT", "9", 2, MAV_PARAM_EXT_TYPE_CUSTOM);
    assert_answer("LED_LIMIT", PARAM_ACK_VALUE_UNSUPPORTED, 7);
    set_integer("LED_LIMIT", 8, MAV_PARAM_EXT_TYPE_INT32);
    assert_answer("LED_LIMIT", PARAM_ACK_ACCEPTED, 8);
    set_integer("NONE", 8, MAV_PARAM_EXT_TYPE_INT32);
    assert_text(MAV_SEVERITY_WARNING, "NONE: no such parameter");
}

static void test_messages_to_others_and_to_all_set_nothing(void)
{
    static const uint8_t others[][2] = {{51, 1}, {50, 2}, {0, 0}, {0, 1}};
    for (size_t i = 0; i < 4; i++) {
        link_start();
        host.target_system = others[i][0];
        host.target_component = others[i][1];
        set_integer("LED_LIMIT", 7, MAV_PARAM_EXT_TYPE_INT32);
        TEST_ASSERT_EQUAL_UINT8(255, dock.settings.led.limit);
        assert_silent();
    }
}

static void run_tests(void)
{
    RUN_TEST(test_the_list_has_each_value_with_its_type);
    RUN_TEST(test_one_is_read_by_name_and_by_index);
    RUN_TEST(test_each_is_set_to_both_ends);
    RUN_TEST(test_every_integer_type_and_a_float_are_read);
    RUN_TEST(test_what_is_refused_is_answered_with_the_value_as_it_is);
    RUN_TEST(test_messages_to_others_and_to_all_set_nothing);
}

SUITE(run_tests)
