#include "loop.h"

#include <esp_system.h>

#include "clock.h"
#include "last_hue.h"
#include "mailbox.h"
#include "port.h"
#include "pwm.h"
#include "storage.h"
#include "watchdog.h"

Loop::Loop(dock_t *dock_to_run) : dock(dock_to_run)
{
}

void Loop::begin(const camera_order_t &first)
{
    order = first;
}

void Loop::turn()
{
    receive();
    camera();
    rest();
    requests();
    leds();
    transmit();
    if (restarting)
        restart_when_silent();
}

void Loop::receive()
{
    uint8_t bytes[256];
    /* A flood of them shall not keep frames waiting. */
    for (int pieces = 0; pieces < 4; pieces++) {
        const size_t n = port_read(bytes, sizeof bytes);
        if (n == 0)
            return;
        dock_receive(dock, bytes, n, clock_ms());
    }
}

static frame_t frame_of(const camera_fb_t &buffer)
{
    frame_t frame = {};
    /* The dock refuses and counts a frame of the wrong length, and so one of
     * another format than was asked for. */
    frame.length = buffer.format == PIXFORMAT_RGB565 ? buffer.len : 0;
    frame.bytes = buffer.buf;
    frame.width = static_cast<uint16_t>(buffer.width);
    frame.height = static_cast<uint16_t>(buffer.height);
    frame.format = FRAME_RGB565;
    return frame;
}

void Loop::camera()
{
    camera_report_t report;
    if (!mailbox_take(&report, LOOP_WAIT_MS))
        return;
    dock_set_camera(dock, &report.camera);
    if (report.event == CAMERA_FRAME) {
        frame_t frame = frame_of(*report.frame);
        frame.age_ms =
            exposure.age_ms(camera_began_us(*report.frame), clock_us());
        dock_frame(dock, &frame, clock_ms());
        watchdog_feed();
    } else if (report.event == CAMERA_FAULT) {
        dock_frame(dock, nullptr, clock_ms());
        watchdog_feed();
    } else if (report.event == CAMERA_PAUSED) {
        paused();
    }
    rest();
    mailbox_done();
}

void Loop::paused()
{
    if (saving)
        save();
    camera_stands = restarting;
}

void Loop::save()
{
    dock_saved(dock, storage_save(dock->settings));
    saving = false;
    order.pause = restarting;
    mailbox_order(order);
}

/* Before the camera's task goes on after a frame, and for what a host wants. */
void Loop::rest()
{
    const uint32_t rest_ms = dock_rest_ms(dock);
    if (rest_ms == order.rest_ms)
        return;
    order.rest_ms = rest_ms;
    mailbox_order(order);
}

void Loop::requests()
{
    switch (dock_take_request(dock)) {
    case DOCK_REQUEST_NONE:
        return;
    case DOCK_REQUEST_SAVE:
        saving = order.pause = true;
        break;
    case DOCK_REQUEST_CAMERA:
        order.settings = dock->settings.camera;
        ++order.serial;
        break;
    case DOCK_REQUEST_REBOOT:
        restarting = order.pause = true;
        restart_ms = clock_ms();
        break;
    }
    mailbox_order(order);
}

void Loop::leds()
{
    uint16_t duty[3];
    dock_led_duties(dock, duty, clock_ms());
    pwm_set(duty, dock->settings.led.common_anode);
    last_hue_keep(dock_hue(dock));
}

void Loop::transmit()
{
    if (out_sent == out_length && !silent) {
        out_sent = 0;
        out_length = dock_transmit(dock, out, sizeof out, clock_ms());
        if (restarting &&
            (out_length == 0 || clock_ms() - restart_ms >= LOOP_LAST_WORDS_MS))
            silent = true;
    }
    if (out_sent < out_length)
        out_sent += port_write(out + out_sent, out_length - out_sent);
}

void Loop::restart_when_silent()
{
    if (!silent || out_sent < out_length || saving || !port_is_idle())
        return;
    /* The chip resets none of its peripherals: a camera that went on filling
     * its buffers would write over the loader's memory, and hang it. */
    if (!camera_stands && clock_ms() - restart_ms < LOOP_PAUSE_MS)
        return;
    /* Dark, not frozen at the last colour, until the next start's decision. */
    pwm_start(dock->settings.led.common_anode);
    esp_restart();
}
