#include "link_order.h"
#include "parameter_table.h"

/* A hue in degrees, 0..360, as hue steps; -1 for anything else. */
static int32_t hue_of_degrees(uint32_t bits)
{
    int32_t hue;
    if (!parameter_from_real32(&PARAMETERS[PARAMETER_LED_HUE], bits, &hue) ||
        hue < 0 || hue > METHOD_HUE_RANGE)
        return -1;
    return hue % METHOD_HUE_RANGE;
}

static uint8_t show_hue(lamps_t *lamps, const order_t *order)
{
    const int32_t hue = hue_of_degrees(order->argument[1]);
    if (hue < 0)
        return MAV_RESULT_DENIED;
    lamps_test_hue(lamps, (uint16_t)hue, order->now_ms);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t show_raw(lamps_t *lamps, const order_t *order)
{
    uint8_t raw[3];
    for (int i = 0; i < 3; i++) {
        const int64_t level = order_whole(order, i + 1);
        if (level < 0 || level > 255)
            return MAV_RESULT_DENIED;
        raw[i] = (uint8_t)level;
    }
    lamps_test_raw(lamps, raw, order->now_ms);
    return MAV_RESULT_ACCEPTED;
}

uint8_t link_obey_led(dock_t *dock, const order_t *order)
{
    switch (order_whole(order, 0)) {
    case DOCK_LED_AUTO:
        if (dock->settings.led_mode == DOCK_LED_AUTO)
            lamps_follow(&dock->lamps, &dock->settings);
        else
            lamps_test_marker(&dock->lamps, order->now_ms);
        return MAV_RESULT_ACCEPTED;
    case DOCK_LED_HUE:
        return show_hue(&dock->lamps, order);
    case DOCK_LED_RAW:
        return show_raw(&dock->lamps, order);
    default:
        return MAV_RESULT_DENIED;
    }
}
