#include "mailbox.h"

#include <freertos/FreeRTOS.h>
#include <freertos/queue.h>

/* A queue of one element, in static memory. */
template <typename T> struct Box {
    QueueHandle_t queue;
    StaticQueue_t state;
    uint8_t storage[sizeof(T)];

    void start()
    {
        queue = xQueueCreateStatic(1, sizeof(T), storage, &state);
    }
};

static Box<camera_order_t> orders;
static Box<camera_report_t> reports;
static Box<uint8_t> done;

void mailbox_start(const camera_order_t &first)
{
    orders.start();
    reports.start();
    done.start();
    mailbox_order(first);
}

void mailbox_order(const camera_order_t &order)
{
    xQueueOverwrite(orders.queue, &order);
}

camera_order_t mailbox_ordered()
{
    camera_order_t order = {};
    xQueuePeek(orders.queue, &order, portMAX_DELAY);
    return order;
}

void mailbox_report(const camera_report_t &report)
{
    uint8_t token = 0;
    xQueueSend(reports.queue, &report, portMAX_DELAY);
    xQueueReceive(done.queue, &token, portMAX_DELAY);
}

bool mailbox_take(camera_report_t *report, uint32_t wait_ms)
{
    return xQueueReceive(reports.queue, report, pdMS_TO_TICKS(wait_ms)) ==
           pdTRUE;
}

void mailbox_done()
{
    const uint8_t token = 1;
    xQueueOverwrite(done.queue, &token);
}
