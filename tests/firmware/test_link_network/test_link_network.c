/* A dock among others: its own system, and messages to everybody. */
#include <string.h>

#include "link_fixture.h"
#include "suite.h"

static void start_as(uint8_t system)
{
    dock_settings_t settings = dock_default_settings();
    settings.system_id = system;
    link_start_with(&settings, QQVGA_BYTES);
    host.target_system = system;
}

static void test_the_default_system_is_that_of_the_definition(void)
{
    TEST_ASSERT_EQUAL_INT32(DOCK_ID_SYSTEM,
                            PARAMETERS[PARAMETER_SYSTEM_ID].initial);
}

static void test_a_dock_speaks_and_listens_as_the_system_of_its_settings(void)
{
    start_as(51);
    tell(wire_parameter_set("LED_LIMIT", 7));
    assert_value("LED_LIMIT", 7); /* its messages are checked by the fixture */
    host.target_system = 50;
    tell(wire_parameter_set("LED_LIMIT", 8));
    assert_silent();
    TEST_ASSERT_EQUAL_UINT8(7, dock.settings.led.limit);
}

static void test_a_new_system_counts_from_the_next_start_on(void)
{
    start_as(50);
    tell(wire_parameter_set("SYSTEM_ID", 51));
    assert_value("SYSTEM_ID", 51);
    tell(wire_parameter_set("LED_LIMIT", 7));
    assert_value("LED_LIMIT", 7);
}

static void test_two_docks_on_one_line_do_not_disturb_each_other(void)
{
    static dock_t other;
    start_as(51);
    other = dock;
    start_as(52);
    tell(wire_parameter_set("LED_LIMIT", 7));
    const wire_t wire = wire_parameter_set("LED_LIMIT", 7);
    dock_receive(&other, wire.bytes, wire.length, 0);
    TEST_ASSERT_EQUAL_UINT8(7, dock.settings.led.limit);
    TEST_ASSERT_EQUAL_UINT8(255, other.settings.led.limit);
}

static void test_the_start_is_said_with_the_docks_name(void)
{
    uint8_t bytes[300];
    dock_settings_t settings = dock_default_settings();
    settings.system_id = 254;
    dock_init(&dock, &settings);
    const dock_board_t board = {15, false, "abcdef01", NULL, 0, 0};
    dock_set_board(&dock, &board);
    const size_t n = dock_transmit(&dock, bytes, sizeof bytes, 0);
    static const char words[] =
        "Chromadock 254 abcdef01 started, reset reason 15";
    bool said = false;
    for (size_t i = 0; i + sizeof words <= n; i++)
        said = said || memcmp(bytes + i, words, sizeof words - 1) == 0;
    TEST_ASSERT_TRUE(said);
}

static void test_the_version_has_the_chips_number(void)
{
    mavlink_autopilot_version_t version;
    start_as(50);
    tell(wire_command(MAV_CMD_REQUEST_MESSAGE, MAVLINK_MSG_ID_AUTOPILOT_VERSION,
                      0, 0, 0));
    hear();
    mavlink_msg_autopilot_version_decode(
        heard(MAVLINK_MSG_ID_AUTOPILOT_VERSION, 0), &version);
    TEST_ASSERT_EQUAL_HEX64(BOARD_UID, version.uid);
}

static void test_what_is_for_everybody_changes_nothing(void)
{
    static const struct {
        uint16_t command;
        float argument;
    } orders[] = {
        {MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1},
        {MAV_CMD_PREFLIGHT_STORAGE, 1},
        {MAV_CMD_PREFLIGHT_STORAGE, 2},
        {MAV_CMD_DOCK_LED, DOCK_LED_RAW},
        {MAV_CMD_DOCK_SNAPSHOT, 0},
        {MAV_CMD_SET_MESSAGE_INTERVAL, MAVLINK_MSG_ID_DOCK_STATUS},
        {MAV_CMD_COMPONENT_ARM_DISARM, 1}, /* the vehicle answers */
    };
    static dock_t before;
    start_as(50);
    tell(wire_parameter_set("LED_LIMIT", 7));
    hear();
    before = dock;
    host.target_system = 0;
    for (uint8_t component = 0; component < 2; component++) {
        host.target_component = component;
        for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
            tell(wire_command(orders[i].command, orders[i].argument, -1, 0, 0));
            tell(wire_command_int(orders[i].command, orders[i].argument, -1, 0,
                                  0));
        }
        tell(wire_parameter_set("LED_LIMIT", 9));
    }
    before.link.receiver = dock.link.receiver;
    TEST_ASSERT_EQUAL_MEMORY(&before, &dock, sizeof dock);
    assert_silent();
}

static void test_questions_to_everybody_are_answered(void)
{
    start_as(50);
    host.target_system = host.target_component = 0;
    tell(wire_parameter_list());
    tell(wire_parameter_read("LED_LIMIT", -1));
    hear();
    TEST_ASSERT_EQUAL_UINT(PARAMETER_COUNT,
                           heard_count(MAVLINK_MSG_ID_PARAM_VALUE));
    tell(wire_command(MAV_CMD_REQUEST_MESSAGE, MAVLINK_MSG_ID_AUTOPILOT_VERSION,
                      0, 0, 0));
    assert_ack(MAV_CMD_REQUEST_MESSAGE, MAV_RESULT_ACCEPTED);
    tell(wire_command(MAV_CMD_GET_MESSAGE_INTERVAL, 0, 0, 0, 0));
    assert_ack(MAV_CMD_GET_MESSAGE_INTERVAL, MAV_RESULT_ACCEPTED);
}

static void test_a_command_with_a_place_is_obeyed_like_one_without(void)
{
    start_as(50);
    tell(wire_command_int(MAV_CMD_DOCK_LED, DOCK_LED_RAW, 1, 2, 3));
    assert_ack(MAV_CMD_DOCK_LED, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(((uint8_t[]){1, 2, 3}), dock.lamps.raw, 3);
    tell(wire_command_int(MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0));
    assert_ack(MAV_CMD_NAV_TAKEOFF, MAV_RESULT_UNSUPPORTED);
    host.target_system = 1;
    tell(wire_command_int(MAV_CMD_DOCK_LED, DOCK_LED_RAW, 9, 9, 9));
    assert_silent();
}

static void test_another_cameras_image_is_not_the_docks_business(void)
{
    mavlink_message_t message;
    const mavlink_data_transmission_handshake_t h = {
        .size = 5000,
        .width = 320,
        .height = 240,
        .packets = 20,
        .type = MAVLINK_DATA_STREAM_IMG_JPEG,
        .payload = 253};
    start_as(50);
    mavlink_msg_data_transmission_handshake_encode(1, 100, &message, &h);
    tell(wire_of(&message));
    assert_silent();
    TEST_ASSERT_EQUAL_UINT32(0, status_now().link_faults);
}

static void run_tests(void)
{
    RUN_TEST(test_the_default_system_is_that_of_the_definition);
    RUN_TEST(test_a_dock_speaks_and_listens_as_the_system_of_its_settings);
    RUN_TEST(test_a_new_system_counts_from_the_next_start_on);
    RUN_TEST(test_two_docks_on_one_line_do_not_disturb_each_other);
    RUN_TEST(test_the_start_is_said_with_the_docks_name);
    RUN_TEST(test_the_version_has_the_chips_number);
    RUN_TEST(test_what_is_for_everybody_changes_nothing);
    RUN_TEST(test_questions_to_everybody_are_answered);
    RUN_TEST(test_a_command_with_a_place_is_obeyed_like_one_without);
    RUN_TEST(test_another_cameras_image_is_not_the_docks_business);
}

SUITE(run_tests)
