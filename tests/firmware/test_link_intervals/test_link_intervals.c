/* Messages on request and by the clock, as ground stations ask for them. */
#include <math.h>

#include "link_fixture.h"
#include "suite.h"

enum { STATUS = MAVLINK_MSG_ID_DOCK_STATUS };

static void interval(float id, float us, uint8_t result)
{
    tell(wire_command(MAV_CMD_SET_MESSAGE_INTERVAL, id, us, 0, 0));
    assert_ack(MAV_CMD_SET_MESSAGE_INTERVAL, result);
}

static size_t count_over(uint32_t ms, uint32_t id)
{
    size_t count = 0;
    for (uint32_t i = 0; i < ms; i++) {
        clock_ms++;
        hear();
        count += heard_count(id);
    }
    return count;
}

/* What the dock says of a message's interval. */
static int32_t told(wire_t request, uint16_t id)
{
    mavlink_message_interval_t answer;
    hear();
    tell(request);
    hear();
    mavlink_msg_message_interval_decode(
        heard(MAVLINK_MSG_ID_MESSAGE_INTERVAL, 0), &answer);
    TEST_ASSERT_EQUAL_UINT16(id, answer.message_id);
    return answer.interval_us;
}

static int32_t told_of(uint16_t id)
{
    const int32_t us =
        told(wire_command(MAV_CMD_GET_MESSAGE_INTERVAL, id, 0, 0, 0), id);
    TEST_ASSERT_EQUAL_INT32(
        us, told(wire_command(MAV_CMD_REQUEST_MESSAGE,
                              MAVLINK_MSG_ID_MESSAGE_INTERVAL, id, 0, 0),
                 id));
    return us;
}

static void test_the_interval_of_each_message_can_be_set(void)
{
    link_start();
    interval(STATUS, 500000, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(20, count_over(10000, STATUS));
    interval(MAVLINK_MSG_ID_AUTOPILOT_VERSION, 2e6f, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(5,
                           count_over(10000, MAVLINK_MSG_ID_AUTOPILOT_VERSION));
    interval(MAVLINK_MSG_ID_HEARTBEAT, 2e6f, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(5, count_over(10000, MAVLINK_MSG_ID_HEARTBEAT));
}

static void test_none_and_as_usual_can_be_asked_for(void)
{
    link_start();
    interval(STATUS, -1, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(0, count_over(3000, STATUS));
    TEST_ASSERT_EQUAL_INT32(-1, told_of(STATUS));
    TEST_ASSERT_EQUAL_UINT32(0, status_now().link_faults);
    interval(STATUS, 0, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(15, count_over(3000, STATUS));
}

static void test_the_interval_is_told(void)
{
    link_start();
    TEST_ASSERT_EQUAL_INT32(200000, told_of(STATUS));
    TEST_ASSERT_EQUAL_INT32(1000000, told_of(MAVLINK_MSG_ID_HEARTBEAT));
    TEST_ASSERT_EQUAL_INT32(-1, told_of(MAVLINK_MSG_ID_AUTOPILOT_VERSION));
    TEST_ASSERT_EQUAL_INT32(0, told_of(MAVLINK_MSG_ID_ATTITUDE));
    interval(STATUS, 1000, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_INT32(33000, told_of(STATUS)); /* the fastest */
}

static void test_the_parameter_has_the_last_word(void)
{
    link_start();
    interval(STATUS, 33333, MAV_RESULT_ACCEPTED);
    tell(wire_parameter_set("REPORT_HZ", 5)); /* as it is */
    hear();
    TEST_ASSERT_EQUAL_UINT(5, count_over(1000, STATUS));
}

static void test_the_heartbeat_cannot_be_silenced(void)
{
    link_start();
    interval(MAVLINK_MSG_ID_HEARTBEAT, -1, MAV_RESULT_DENIED);
    TEST_ASSERT_EQUAL_UINT(3, count_over(3000, MAVLINK_MSG_ID_HEARTBEAT));
}

static void test_intervals_that_are_none_are_denied(void)
{
    static const float wrong[] = {-2, NAN, INFINITY, 3e9f};
    link_start();
    for (size_t i = 0; i < 4; i++)
        interval(STATUS, wrong[i], MAV_RESULT_DENIED);
    TEST_ASSERT_EQUAL_UINT(5, count_over(1000, STATUS));
}

/* A ground station asks everybody for everything: the cable is sound. */
static void test_a_message_that_the_dock_does_not_have_is_no_fault(void)
{
    static const float ids[] = {300, 397, 1, 0.5f, NAN, -1, 16777215};
    link_start();
    for (size_t i = 0; i < 7; i++) {
        tell(wire_command(MAV_CMD_REQUEST_MESSAGE, ids[i], 0, 0, 0));
        assert_ack(MAV_CMD_REQUEST_MESSAGE, MAV_RESULT_UNSUPPORTED);
        interval(ids[i], 100000, MAV_RESULT_UNSUPPORTED);
    }
    interval(MAVLINK_MSG_ID_MESSAGE_INTERVAL, 1e6f, MAV_RESULT_UNSUPPORTED);
    tell(wire_parameter_read("SYSID_THISMAV", -1));
    tell(wire_parameter_read("", 300));
    hear();
    TEST_ASSERT_EQUAL_UINT32(0, status_now().link_faults);
}

static void test_a_heartbeat_comes_on_request(void)
{
    link_start();
    tell(wire_command(MAV_CMD_REQUEST_MESSAGE, MAVLINK_MSG_ID_HEARTBEAT, 0, 0,
                      0));
    assert_ack(MAV_CMD_REQUEST_MESSAGE, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT(1, heard_count(MAVLINK_MSG_ID_HEARTBEAT));
}

static void run_tests(void)
{
    RUN_TEST(test_the_interval_of_each_message_can_be_set);
    RUN_TEST(test_none_and_as_usual_can_be_asked_for);
    RUN_TEST(test_the_interval_is_told);
    RUN_TEST(test_the_parameter_has_the_last_word);
    RUN_TEST(test_the_heartbeat_cannot_be_silenced);
    RUN_TEST(test_intervals_that_are_none_are_denied);
    RUN_TEST(test_a_message_that_the_dock_does_not_have_is_no_fault);
    RUN_TEST(test_a_heartbeat_comes_on_request);
}

SUITE(run_tests)
