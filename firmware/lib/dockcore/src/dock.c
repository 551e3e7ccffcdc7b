#include "dock.h"

#include <string.h>

#include "counter.h"
#include "link_parts.h"

void dock_init(dock_t *dock, const dock_settings_t *settings)
{
    memset(dock, 0, sizeof *dock);
    dock->settings =
        dock_settings_are_valid(settings) ? *settings : dock_default_settings();
    decision_init(&dock->decision);
    lamps_follow(&dock->lamps, &dock->settings);
    dock->link.system = dock->settings.system_id;
}

void dock_set_board(dock_t *dock, const dock_board_t *board)
{
    dock->board = *board;
    line_t line = {{0}, 0};
    char hash[sizeof board->git_hash + 1] = {0};
    memcpy(hash, board->git_hash, sizeof board->git_hash);
    line_add(&line, "Chromadock ");
    line_add_fixed(&line, dock->link.system, 0);
    line_add(&line, " ");
    line_add(&line, hash);
    line_add(&line, " started, reset reason ");
    line_add_fixed(&line, board->reset_reason, 0);
    link_say(&dock->link, MAV_SEVERITY_INFO, &line);
    if (board->settings_corrupt)
        link_say_words(&dock->link, MAV_SEVERITY_WARNING,
                       "stored settings corrupt: defaults in use");
}

void dock_set_camera(dock_t *dock, const dock_camera_t *camera)
{
    dock->camera = *camera;
}

static void camera_fault(dock_t *dock)
{
    count(&dock->camera_faults);
    if (!dock->camera_lost)
        link_say_words(&dock->link, MAV_SEVERITY_ERROR,
                       "camera gives no frame: colour kept, restarting it");
    dock->camera_lost = true;
}

void dock_frame(dock_t *dock, const frame_t *frame, uint32_t now_ms)
{
    const bool injecting = link_injection_lasts(&dock->link, now_ms);
    if (frame == NULL || frame->bytes == NULL) {
        camera_fault(dock);
        return;
    }
    if (dock->camera_lost)
        link_say_words(&dock->link, MAV_SEVERITY_NOTICE, "camera is back");
    dock->camera_lost = false;
    if (injecting)
        return;
    if (decision_frame(&dock->decision, frame, &dock->settings, now_ms))
        link_take_snapshot(dock, frame, now_ms);
}

void dock_receive(dock_t *dock, const uint8_t *bytes, size_t n, uint32_t now_ms)
{
    link_receive(dock, bytes, n, now_ms);
}

size_t dock_transmit(dock_t *dock, uint8_t *bytes, size_t capacity,
                     uint32_t now_ms)
{
    link_receive(dock, NULL, 0, now_ms);
    if (lamps_expire(&dock->lamps, &dock->settings, now_ms))
        link_say_words(&dock->link, MAV_SEVERITY_NOTICE,
                       "LED test ended after 10 minutes: LED_MODE again");
    return link_transmit(dock, bytes, capacity, now_ms);
}

dock_request_t dock_take_request(dock_t *dock)
{
    return requests_take(&dock->requests, link_has_answered(&dock->link));
}

void dock_saved(dock_t *dock, bool written)
{
    if (written)
        dock->board.settings_corrupt = false;
    else
        link_say_words(&dock->link, MAV_SEVERITY_ERROR,
                       "settings could not be saved: flash fault");
    if (requests_saved(&dock->requests, written))
        link_answer_save(&dock->link, written);
}

void dock_led_duties(const dock_t *dock, uint16_t duty[3])
{
    lamps_duties(&dock->lamps, &dock->decision, &dock->settings.led, duty);
}
