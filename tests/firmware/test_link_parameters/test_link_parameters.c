/* Parameters over the link: listed, read, set, refused. */
#include <math.h>
#include <string.h>

#include "fixture.h"
#include "link_fixture.h"
#include "suite.h"

static float shown(const parameter_t *p, int32_t stored)
{
    return (float)stored * (float)p->numerator / (float)(1u << p->shift);
}

static int32_t stored(int index)
{
    return parameter_get(&PARAMETERS[index], &dock.settings);
}

static void set(const char *name, float value)
{
    tell(wire_parameter_set(name, value));
}

static void assert_listed_from(int first)
{
    hear();
    TEST_ASSERT_EQUAL_UINT((size_t)(PARAMETER_COUNT - first),
                           heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
    for (int i = first; i < PARAMETER_COUNT; i++) {
        mavlink_param_value_t value;
        mavlink_msg_param_value_decode(
            heard(MAVLINK_MSG_ID_PARAM_VALUE, (size_t)(i - first)), &value);
        TEST_ASSERT_EQUAL_UINT16(i, value.param_index);
        TEST_ASSERT_EQUAL_UINT16(PARAMETER_COUNT, value.param_count);
        TEST_ASSERT_EQUAL_STRING_LEN(PARAMETERS[i].name, value.param_id, 16);
        TEST_ASSERT_TRUE(value.param_value ==
                         shown(&PARAMETERS[i], PARAMETERS[i].initial));
    }
}

static void test_the_list_is_each_parameter_once_in_order(void)
{
    link_start();
    tell(wire_parameter_list());
    assert_listed_from(0);
    assert_silent();
}

static void test_two_list_requests_at_once_are_answered_once(void)
{
    link_start();
    tell(wire_parameter_list());
    tell(wire_parameter_list());
    assert_listed_from(0);
}

/* Which of them came, a bit each. */
static uint32_t heard_indices(void)
{
    uint32_t indices = 0;
    mavlink_param_value_t value;
    for (size_t i = 0; i < heard_count(MAVLINK_MSG_ID_PARAM_VALUE); i++) {
        mavlink_msg_param_value_decode(heard(MAVLINK_MSG_ID_PARAM_VALUE, i),
                                       &value);
        indices |= UINT32_C(1) << value.param_index;
    }
    return indices;
}

/* Two ground stations on a slow line: the end of the list is reached though it
 * is asked for anew before. */
static void test_repeated_list_requests_starve_no_parameter(void)
{
    link_start();
    for (int i = 0; i < 4; i++) {
        tell(wire_parameter_list());
        const size_t before = heard_count(MAVLINK_MSG_ID_PARAM_VALUE);
        while (heard_count(MAVLINK_MSG_ID_PARAM_VALUE) < before + 10)
            hear_once(40);
    }
    TEST_ASSERT_EQUAL_HEX32((UINT64_C(1) << PARAMETER_COUNT) - 1,
                            heard_indices());
}

static void test_a_list_request_in_the_middle_sends_each_once_more(void)
{
    link_start();
    tell(wire_parameter_list());
    while (heard_count(MAVLINK_MSG_ID_PARAM_VALUE) < 10)
        hear_once(40);
    tell(wire_parameter_list());
    hear();
    TEST_ASSERT_EQUAL_UINT(PARAMETER_COUNT,
                           heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
    TEST_ASSERT_EQUAL_HEX32((UINT64_C(1) << PARAMETER_COUNT) - 1,
                            heard_indices());
    tell(wire_parameter_list());
    assert_listed_from(0);
}

static void test_each_is_read_by_name_and_by_index(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        tell(wire_parameter_read(p->name, -1));
        assert_value(p->name, shown(p, p->initial));
        tell(wire_parameter_read("", (int16_t)i));
        assert_value(p->name, shown(p, p->initial));
    }
}

static void test_an_index_has_precedence_over_the_name(void)
{
    link_start();
    tell(wire_parameter_read("LED_HUE", PARAMETER_LED_LIMIT));
    assert_value("LED_LIMIT", 255);
}

static void test_an_index_beyond_the_last_has_no_value(void)
{
    static const int16_t beyond[] = {PARAMETER_COUNT, 31, 32, 33, INT16_MAX};
    link_start();
    for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; i++) {
        tell(wire_parameter_read("", beyond[i]));
        hear();
        TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
    }
}

static void test_each_is_set_to_both_ends_and_answers_with_the_value(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t values[] = {p->maximum, p->minimum, p->initial};
        for (size_t k = 0; k < 3; k++) {
            set(p->name, shown(p, values[k]));
            assert_value(p->name, shown(p, values[k]));
            TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
            TEST_ASSERT_EQUAL_INT32(values[k], stored(i));
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, status_now().link_faults);
}

/* Answered with the value as it was, and a text. */
static void assert_value_refused(const parameter_t *p, float value)
{
    const dock_settings_t before = dock.settings;
    const uint32_t faults = dock.link.faults;
    set(p->name, value);
    assert_value(p->name, shown(p, parameter_get(p, &before)));
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_STATUSTEXT));
    TEST_ASSERT_EQUAL_MEMORY(&before, &dock.settings, sizeof before);
    TEST_ASSERT_EQUAL_UINT32(faults + 1, dock.link.faults);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
}

static void test_each_keeps_its_value_where_another_is_out_of_range(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        assert_value_refused(p, shown(p, p->maximum + 1));
        assert_value_refused(p, shown(p, p->minimum - 1));
        assert_value_refused(p, 1e9f);
        assert_value_refused(p, -1e9f);
        assert_value_refused(p, 3e38f);
    }
}

static void test_what_is_no_number_is_refused_for_each(void)
{
    link_start();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        assert_value_refused(&PARAMETERS[i], NAN);
        assert_value_refused(&PARAMETERS[i], -NAN);
        assert_value_refused(&PARAMETERS[i], INFINITY);
        assert_value_refused(&PARAMETERS[i], -INFINITY);
    }
}

static void assert_refusal(const char *name, float value, const char *text)
{
    link_start();
    set(name, value);
    assert_text(MAV_SEVERITY_WARNING, text);
}

static void test_the_refusal_names_the_range(void)
{
    assert_refusal("LED_LIMIT", 256, "LED_LIMIT refused: allowed 0 to 255");
    assert_refusal("WINDOW_MS", 99, "WINDOW_MS refused: allowed 100 to 2000");
    assert_refusal("CAM_GAIN", -2, "CAM_GAIN refused: allowed -1 to 30");
    assert_refusal("LED_OFFSET_G", 256,
                   "LED_OFFSET_G refused: allowed -255 to 255");
    assert_refusal("LINK_BAUD", 0, "LINK_BAUD refused: allowed 9600 to 921600");
}

/* Whoever sets the end that a refusal names is not refused again. */
static void test_both_ends_that_a_refusal_names_are_allowed(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        double low, high;
        mavlink_statustext_t text;
        char words[sizeof text.text + 1] = {0};
        link_start();
        set(p->name, 1e9f);
        hear();
        mavlink_msg_statustext_decode(heard(MAVLINK_MSG_ID_STATUSTEXT, 0),
                                      &text);
        memcpy(words, text.text, sizeof text.text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            2, sscanf(words, "%*s refused: allowed %lf to %lf", &low, &high),
            words);
        set(p->name, (float)low);
        hear();
        TEST_ASSERT_EQUAL_INT32_MESSAGE(p->minimum, stored(i), words);
        set(p->name, (float)high);
        hear();
        TEST_ASSERT_EQUAL_UINT_MESSAGE(
            0, heard_count(MAVLINK_MSG_ID_STATUSTEXT), words);
        /* Three digits behind the point are shown. */
        TEST_ASSERT_TRUE_MESSAGE(
            shown(p, p->maximum) - shown(p, stored(i)) < 0.0011f, words);
    }
}

static void test_unknown_names_are_refused_by_name(void)
{
    link_start();
    set("NO_SUCH", 1);
    assert_text(MAV_SEVERITY_WARNING, "NO_SUCH: no such parameter");
    TEST_ASSERT_EQUAL_UINT(0, heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
    tell(wire_parameter_read("led_limit", -1));
    assert_text(MAV_SEVERITY_WARNING, "led_limit: no such parameter");
    set("", 1);
    assert_text(MAV_SEVERITY_WARNING, ": no such parameter");
    TEST_ASSERT_EQUAL_UINT32(2, status_now().link_faults); /* set, not read */
}

static void test_a_name_of_sixteen_letters_is_read_no_further(void)
{
    link_start();
    set("ABCDEFGHIJKLMNOP", 1);
    assert_text(MAV_SEVERITY_WARNING, "ABCDEFGHIJKLMNOP: no such parameter");
    set("LED_LIMIT_______", 1);
    assert_text(MAV_SEVERITY_WARNING, "LED_LIMIT_______: no such parameter");
    set("LED_LIMI", 1);
    assert_text(MAV_SEVERITY_WARNING, "LED_LIMI: no such parameter");
}

static void test_camera_settings_are_handed_to_the_board_when_they_change(void)
{
    link_start();
    set("CAM_EXPOSURE", 0); /* as it is */
    set("LED_LIMIT", 9);
    TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    static const char *const names[] = {"CAM_EXPOSURE", "CAM_GAIN", "CAM_WB",
                                        "CAM_LOCK"};
    for (int i = 0; i < 4; i++) {
        set(names[i], i == 3 ? 0 : 3);
        TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_CAMERA, dock_take_request(&dock));
        TEST_ASSERT_EQUAL_INT(DOCK_REQUEST_NONE, dock_take_request(&dock));
    }
}

static void test_manual_mode_shows_the_hue_at_once(void)
{
    uint16_t duty[3];
    link_start();
    set("LED_ANODE", 0);
    set("LED_HUE", 120);
    set("LED_MODE", 1);
    dock_led_duties(&dock, duty, 0);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(((uint16_t[]){0, 4096, 0}), duty, 3);
    set("LED_MODE", 0);
    dock_led_duties(&dock, duty, 0);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(((uint16_t[]){0, 0, 0}), duty, 3);
}

static void show(colour_t water, uint32_t now_ms)
{
    const canvas_t canvas = canvas_of(FRAME_RGB888, 4, 3, water);
    dock_frame(&dock, &canvas.frame, now_ms);
    canvas_free_all();
}

static void test_another_mapping_shows_its_hue_at_once_and_nothing_between(void)
{
    link_start();
    for (uint32_t i = 0; i < 30; i++)
        show((colour_t){0, 0, 200}, 100 * i);
    TEST_ASSERT_EQUAL_UINT16(0, dock_hue(&dock));

    set("MAPPING", METHOD_MAPPING_COMPLEMENT);

    TEST_ASSERT_EQUAL_UINT16(256, dock_hue(&dock));
    for (uint32_t i = 30; i < 60; i++) {
        show((colour_t){0, 0, 200}, 100 * i);
        TEST_ASSERT_EQUAL_UINT16(256, dock_hue(&dock));
    }
}

static void test_another_fallback_is_shown_at_once_and_nothing_between(void)
{
    link_start();
    for (uint32_t i = 0; i < 30; i++)
        show((colour_t){90, 90, 90}, 100 * i);
    set("FALLBACK_HUE", 240);
    TEST_ASSERT_EQUAL_UINT16(1024, dock_hue(&dock));
    show((colour_t){90, 90, 90}, 3000);
    TEST_ASSERT_EQUAL_UINT16(1024, dock_hue(&dock));
}

static void test_a_fallback_set_before_the_first_frame_is_the_one_shown(void)
{
    link_start();
    set("FALLBACK_HUE", 240);
    TEST_ASSERT_EQUAL_UINT16(1024, dock_hue(&dock));
}

static void run_tests(void)
{
    RUN_TEST(test_another_mapping_shows_its_hue_at_once_and_nothing_between);
    RUN_TEST(test_another_fallback_is_shown_at_once_and_nothing_between);
    RUN_TEST(test_a_fallback_set_before_the_first_frame_is_the_one_shown);

    RUN_TEST(test_the_list_is_each_parameter_once_in_order);
    RUN_TEST(test_two_list_requests_at_once_are_answered_once);
    RUN_TEST(test_repeated_list_requests_starve_no_parameter);
    RUN_TEST(test_a_list_request_in_the_middle_sends_each_once_more);
    RUN_TEST(test_each_is_read_by_name_and_by_index);
    RUN_TEST(test_an_index_has_precedence_over_the_name);
    RUN_TEST(test_an_index_beyond_the_last_has_no_value);
    RUN_TEST(test_each_is_set_to_both_ends_and_answers_with_the_value);
    RUN_TEST(test_each_keeps_its_value_where_another_is_out_of_range);
    RUN_TEST(test_what_is_no_number_is_refused_for_each);
    RUN_TEST(test_the_refusal_names_the_range);
    RUN_TEST(test_both_ends_that_a_refusal_names_are_allowed);
    RUN_TEST(test_unknown_names_are_refused_by_name);
    RUN_TEST(test_a_name_of_sixteen_letters_is_read_no_further);
    RUN_TEST(test_camera_settings_are_handed_to_the_board_when_they_change);
    RUN_TEST(test_manual_mode_shows_the_hue_at_once);
}

SUITE(run_tests)
