/* Commands that ask for messages, once or by the clock. */
#include "link_order.h"
#include "real32.h"

/* As fast as REPORT_HZ allows, and slow enough for anybody. */
#define SHORTEST_US 33000
#define LONGEST_US INT64_C(2000000000)

static uint8_t ask(link_t *link, report_t report)
{
    link_ask_for_report(link, report);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t ask_for_interval(dock_t *dock, int64_t id)
{
    if (id < 0 || id > UINT16_MAX)
        return MAV_RESULT_DENIED;
    link_ask_for_interval(&dock->link, (uint16_t)id);
    return MAV_RESULT_ACCEPTED;
}

uint8_t link_obey_request_message(dock_t *dock, const order_t *order)
{
    const int report = link_report_of(order_whole(order, 0));
    if (report < 0)
        return MAV_RESULT_UNSUPPORTED;
    if (report == REPORT_INTERVAL)
        return ask_for_interval(dock, order_whole(order, 1));
    return ask(&dock->link, (report_t)report);
}

uint8_t link_obey_request_version(dock_t *dock, const order_t *order)
{
    (void)order;
    return ask(&dock->link, REPORT_VERSION);
}

uint8_t link_obey_get_interval(dock_t *dock, const order_t *order)
{
    return ask_for_interval(dock, order_whole(order, 0));
}

/* Microseconds in argument 1; 0: as usual, -1: never by the clock. */
uint8_t link_obey_set_interval(dock_t *dock, const order_t *order)
{
    const int report = link_report_of(order_whole(order, 0));
    int64_t us;
    if (report < 0 || report == REPORT_INTERVAL)
        return MAV_RESULT_UNSUPPORTED;
    if (!real32_to_fixed(order->argument[1], 0, &us) || us < -1 ||
        us > LONGEST_US)
        return MAV_RESULT_DENIED;
    /* Without heartbeats the dock would count as gone. */
    if (us == -1 && report == REPORT_HEARTBEAT)
        return MAV_RESULT_DENIED;
    const int64_t kept = us > SHORTEST_US ? us : SHORTEST_US;
    link_set_period(&dock->link, (report_t)report,
                    us == -1  ? REPORT_OFF
                    : us == 0 ? 0
                              : (uint32_t)(kept / 1000));
    return MAV_RESULT_ACCEPTED;
}
