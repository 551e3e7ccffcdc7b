#include "dock.h"

#include <string.h>

#include "link_parts.h"

/* A host that stops injecting without saying so gets the camera back. */
#define INJECTION_MS 3000

void dock_init(dock_t *dock, const dock_settings_t *settings)
{
    memset(dock, 0, sizeof *dock);
    dock->settings =
        dock_settings_are_valid(settings) ? *settings : dock_default_settings();
    dock->led_mode = dock->settings.led_mode;
    dock->led_hue = dock->settings.led_hue;
    rolling_init(&dock->rolling);
}

void dock_set_board(dock_t *dock, const dock_board_t *board)
{
    dock->board = *board;
    line_t line = {{0}, 0};
    char hash[sizeof board->git_hash + 1] = {0};
    memcpy(hash, board->git_hash, sizeof board->git_hash);
    line_add(&line, "Chromadock ");
    line_add(&line, hash);
    line_add(&line, " started, reset reason ");
    line_add_fixed(&line, board->reset_reason, 0);
    link_say(dock, MAV_SEVERITY_INFO, &line);
    if (board->settings_corrupt) {
        dock->faults |= DOCK_FAULT_SETTINGS;
        link_say_words(dock, MAV_SEVERITY_WARNING,
                       "stored settings corrupt: defaults in use");
    }
}

void dock_set_camera(dock_t *dock, const dock_camera_t *camera)
{
    dock->camera = *camera;
}

static void count(uint32_t *counter)
{
    if (*counter < UINT32_MAX)
        ++*counter;
}

/* A mean over about eight frames; 0 as long as it is not known. */
static void measure_rate(dock_t *dock, uint32_t now_ms)
{
    const uint32_t longest = 60000;
    const uint32_t apart = now_ms - dock->last_frame_ms;
    const uint32_t period = 256 * (apart == 0        ? 1
                                   : apart < longest ? apart
                                                     : longest);
    if (dock->counters.frames > 0)
        dock->frame_period_q8 = dock->frame_period_q8 == 0
                                    ? period
                                    : (7 * dock->frame_period_q8 + period) / 8;
    dock->last_frame_ms = now_ms;
}

bool dock_decide(dock_t *dock, const frame_t *frame, uint32_t now_ms)
{
    if (!frame_is_valid(frame)) {
        count(&dock->counters.frame_faults);
        dock->faults |= DOCK_FAULT_FRAME;
        return false;
    }
    dock->faults &= (uint16_t)~DOCK_FAULT_FRAME;
    measure_rate(dock, now_ms);
    count(&dock->counters.frames);
    smoothed_open(&dock->smoothed, frame);
    background_from_rows(&dock->background, smoothed_rows, &dock->smoothed,
                         dock->background.bin);
    dock->decided_hue = marker_hue(&dock->background, dock->settings.mapping,
                                   dock->settings.fallback_hue);
    dock->marker_hue = rolling_add(&dock->rolling, dock->decided_hue, now_ms,
                                   dock->settings.window_ms);
    dock->decided = true;
    return true;
}

static void camera_fault(dock_t *dock)
{
    count(&dock->counters.camera_faults);
    if ((dock->faults & DOCK_FAULT_CAMERA) == 0)
        link_say_words(dock, MAV_SEVERITY_ERROR,
                       "camera gives no frame: colour kept, restarting it");
    dock->faults |= DOCK_FAULT_CAMERA;
}

void dock_frame(dock_t *dock, const frame_t *frame, uint32_t now_ms)
{
    link_t *link = &dock->link;
    if (link->injecting && now_ms - link->injected_ms > INJECTION_MS) {
        link->injecting = false;
        link->injected.size = 0;
    }
    if (frame == NULL || frame->bytes == NULL) {
        camera_fault(dock);
        return;
    }
    if ((dock->faults & DOCK_FAULT_CAMERA) != 0)
        link_say_words(dock, MAV_SEVERITY_NOTICE, "camera is back");
    dock->faults &= (uint16_t)~DOCK_FAULT_CAMERA;
    if (link->injecting)
        return;
    if (dock_decide(dock, frame, now_ms))
        link_take_snapshot(dock, frame);
}

dock_request_t dock_take_request(dock_t *dock)
{
    /* A reboot waits for all else, and for its own acknowledgement. */
    const dock_request_t order[] = {DOCK_REQUEST_SAVE, DOCK_REQUEST_CAMERA,
                                    DOCK_REQUEST_REBOOT};
    for (size_t i = 0; i < sizeof order / sizeof order[0]; i++) {
        const uint8_t bit = (uint8_t)(1u << order[i]);
        if ((dock->requests & bit) == 0)
            continue;
        if (order[i] == DOCK_REQUEST_REBOOT &&
            (dock->link.ack_count > 0 || dock->link.saving))
            continue;
        dock->requests &= (uint8_t)~bit;
        return order[i];
    }
    return DOCK_REQUEST_NONE;
}

void dock_saved(dock_t *dock, bool written)
{
    link_t *link = &dock->link;
    if (written) {
        dock->faults &= (uint16_t)~(DOCK_FAULT_STORAGE | DOCK_FAULT_SETTINGS);
    } else {
        dock->faults |= DOCK_FAULT_STORAGE;
        link_say_words(dock, MAV_SEVERITY_ERROR,
                       "settings could not be saved: flash fault");
    }
    if (!link->saving)
        return;
    link->saving = false;
    link->save_ack.result = written ? MAV_RESULT_ACCEPTED : MAV_RESULT_FAILED;
    link_acknowledge(dock, &link->save_ack);
}

void dock_led_duties(const dock_t *dock, uint16_t duty[3])
{
    const led_settings_t *led = &dock->settings.led;
    if (dock->led_mode == DOCK_LED_RAW)
        led_raw_duties(duty, dock->led_raw, led);
    else if (dock->led_mode == DOCK_LED_HUE)
        led_duties(duty, dock->led_hue, led);
    else if (dock->decided)
        led_duties(duty, dock->marker_hue, led);
    else
        led_dark(duty, led);
}
