#include <stddef.h>
#include <string.h>

#include "link_order.h"

static uint8_t store(dock_t *dock, const order_t *order)
{
    const link_ack_t later = {order->command, MAV_RESULT_FAILED, order->system,
                              order->component};
    switch (order_whole(order, 0)) {
    case 1: /* write */
        requests_save(&dock->requests);
        link_answer_save_later(&dock->link, &later);
        return MAV_RESULT_IN_PROGRESS;
    case 2: /* back to the defaults; not yet in flash */
        link_reset_settings(dock);
        link_values_due(&dock->link, VALUE_FLOAT, LINK_ALL_VALUES);
        return MAV_RESULT_ACCEPTED;
    default:
        return MAV_RESULT_DENIED;
    }
}

static uint8_t reboot(dock_t *dock, const order_t *order)
{
    if (order_whole(order, 0) != 1)
        return MAV_RESULT_DENIED;
    requests_reboot(&dock->requests);
    return MAV_RESULT_ACCEPTED;
}

/* A new one, or packets of the last one again. */
static uint8_t snapshot(dock_t *dock, const order_t *order)
{
    const int64_t number = order_whole(order, 0);
    if (dock->board.buffer == NULL)
        return MAV_RESULT_UNSUPPORTED;
    if (number > 0)
        return link_repeat_snapshot(&dock->link, number, order_whole(order, 1),
                                    order_whole(order, 2))
                   ? MAV_RESULT_ACCEPTED
                   : MAV_RESULT_DENIED;
    return link_want_snapshot(&dock->link, order->now_ms)
               ? MAV_RESULT_ACCEPTED
               : MAV_RESULT_TEMPORARILY_REJECTED;
}

static const struct {
    uint16_t command;
    bool to_all; /* changes nothing: answered too where every system is asked */
    link_obey_t *obey;
} orders[] = {
    {MAV_CMD_DOCK_LED, false, link_obey_led},
    {MAV_CMD_DOCK_SNAPSHOT, false, snapshot},
    {MAV_CMD_PREFLIGHT_STORAGE, false, store},
    {MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, false, reboot},
    {MAV_CMD_REQUEST_MESSAGE, true, link_obey_request_message},
    {MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, true, link_obey_request_version},
    {MAV_CMD_SET_MESSAGE_INTERVAL, false, link_obey_set_interval},
    {MAV_CMD_GET_MESSAGE_INTERVAL, true, link_obey_get_interval},
};

#define ORDERS (sizeof orders / sizeof orders[0])

static void obey(dock_t *dock, const order_t *order, bool to_all)
{
    link_ack_t ack = {order->command, MAV_RESULT_UNSUPPORTED, order->system,
                      order->component};
    size_t i = 0;
    while (i < ORDERS && orders[i].command != order->command)
        i++;
    /* Of a command to everybody the vehicle does its part, and says so. */
    if (to_all && (i == ORDERS || !orders[i].to_all))
        return;
    if (i < ORDERS)
        ack.result = orders[i].obey(dock, order);
    if (ack.result == MAV_RESULT_DENIED)
        link_count_fault(&dock->link);
    link_acknowledge(&dock->link, &ack);
}

#define SAME_PLACE(field)                       \
    (offsetof(mavlink_command_long_t, field) == \
     offsetof(mavlink_command_int_t, field))

_Static_assert(SAME_PLACE(param1) && SAME_PLACE(param4) &&
                   SAME_PLACE(command) && SAME_PLACE(target_system) &&
                   SAME_PLACE(target_component),
               "link_on_command reads either message");

/* What COMMAND_LONG and COMMAND_INT have in common; the place that the second
 * one has besides means nothing to a dock. */
void link_on_command(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    mavlink_command_long_t c;
    message_read(&c, sizeof c, message);
    order_t order = {.command = c.command,
                     .system = message->system,
                     .component = message->component,
                     .now_ms = now_ms};
    memcpy(order.argument, &c, sizeof order.argument);
    if (link_is_for_us(&dock->link, c.target_system, c.target_component))
        obey(dock, &order, c.target_system == 0);
}
