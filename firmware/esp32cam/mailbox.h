/* Orders and reports between the colour task and the camera's.
 *
 * The camera's task hands over a report and waits until the colour task is done
 * with it: a frame has one owner at any time, and the driver is never stopped
 * while a frame of it is in use. */
#ifndef MAILBOX_H
#define MAILBOX_H

#include <stdint.h>

#include "camera.h"

/* Before any other of these. */
void mailbox_start(const camera_order_t &first);

/* The colour task's side. */
void mailbox_order(const camera_order_t &order);
bool mailbox_take(camera_report_t *report, uint32_t wait_ms);
void mailbox_done();

/* The camera task's side; mailbox_report waits for mailbox_done. */
camera_order_t mailbox_ordered();
void mailbox_report(const camera_report_t &report);

#endif
