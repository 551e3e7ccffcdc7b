/* A camera on the fake board, and steps of it. */
#ifndef CAMERA_FIXTURE_H
#define CAMERA_FIXTURE_H

#include "shell.h"

inline camera_order_t standard_order()
{
    camera_order_t order = {};
    order.settings.lock = 1;
    order.settings.exposure = 0;
    order.settings.gain = -1;
    order.settings.white_balance = 1;
    order.serial = 1;
    return order;
}

/* Water of one colour; green up to 63. */
inline void paint(int red, int green, int blue)
{
    const int word = red << 11 | green << 5 | blue;
    for (size_t i = 0; i < sizeof board.pixels; i += 2) {
        board.pixels[i] = static_cast<uint8_t>(word >> 8);
        board.pixels[i + 1] = static_cast<uint8_t>(word);
    }
}

/* Steps, as the camera's task does them, until such a report comes; its frame
 * is given back. */
inline camera_report_t step_until(Camera &camera, camera_event_t event,
                                  const camera_order_t &order)
{
    for (int steps = 0; steps < 10000; steps++) {
        const camera_report_t report = camera.step(order);
        camera.release(report);
        if (report.event == event)
            return report;
        if (report.event == CAMERA_NOTHING)
            pass_ms(10);
    }
    TEST_FAIL_MESSAGE("no such report");
    return camera_report_t();
}

inline int64_t now_ms()
{
    return board.us / 1000;
}

#endif
