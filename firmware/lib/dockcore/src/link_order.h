/* A command as the dock obeys it, whichever message brought it. */
#ifndef LINK_ORDER_H
#define LINK_ORDER_H

#include "link_parts.h"

typedef struct {
    uint16_t command;
    uint32_t argument[4];      /* bits of IEEE 754 numbers, as they came */
    uint8_t system, component; /* who gives it */
    uint32_t now_ms;
} order_t;

/* Does what the command says and returns a MAV_RESULT. */
typedef uint8_t link_obey_t(dock_t *dock, const order_t *order);

/* Argument 0..3 as a whole number, 0 or more; -1 for any other. */
int64_t order_whole(const order_t *order, int argument);

/* link_led.c */
link_obey_t link_obey_led;

/* link_requests.c */
link_obey_t link_obey_request_message, link_obey_set_interval,
    link_obey_get_interval, link_obey_request_version;

#endif
