#include "dock.h"

#include <string.h>

#include "counter.h"
#include "link_parts.h"

void dock_init(dock_t *dock, const dock_settings_t *settings)
{
    memset(dock, 0, sizeof *dock);
    dock->settings = *settings;
    dock_mend_settings(&dock->settings);
    decision_init(&dock->decision, dock->settings.fallback_hue);
    look_init(&dock->look);
    lamps_follow(&dock->lamps, &dock->settings);
    dock->link.system = dock->settings.system_id;
}

static void tell_settings(link_t *link, dock_stored_t stored)
{
    if (stored == DOCK_STORED_LOST)
        link_say_words(link, MAV_SEVERITY_WARNING,
                       "stored settings corrupt: defaults in use");
    else if (stored == DOCK_STORED_IN_PART)
        link_say_words(link, MAV_SEVERITY_WARNING,
                       "a stored setting was out of range: default used");
    else if (stored == DOCK_STORED_RESTORED)
        link_say_words(link, MAV_SEVERITY_NOTICE,
                       "stored settings damaged: second copy used");
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
    tell_settings(&dock->link, board->settings);
}

void dock_set_camera(dock_t *dock, const dock_camera_t *camera)
{
    dock->camera = *camera;
}

void dock_set_last_hue(dock_t *dock, uint16_t hue)
{
    if (!dock->decision.decided && hue < METHOD_HUE_RANGE)
        decision_init(&dock->decision, hue);
}

uint16_t dock_hue(const dock_t *dock)
{
    return dock->decision.steady.shown;
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
    link_expire_injection(&dock->link, now_ms);
    lamps_turn(&dock->lamps, now_ms);
    if (frame == NULL || frame->bytes == NULL) {
        camera_fault(dock);
        return;
    }
    if (dock->camera_lost)
        link_say_words(&dock->link, MAV_SEVERITY_NOTICE, "camera is back");
    dock->camera_lost = false;
    if (link_is_injecting(&dock->link))
        return;
    if (!decision_see(&dock->decision, frame, &dock->settings, now_ms))
        return;
    look_frame(&dock->look, &dock->decision, &dock->settings,
               lamps_follow_water(&dock->lamps), now_ms - frame->age_ms,
               now_ms);
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

uint32_t dock_rest_ms(const dock_t *dock)
{
    const bool wanted =
        dock->link.snapshot.state == SNAPSHOT_WANTED || look_waits(&dock->look);
    return dock->decision.decided && !wanted ? dock->settings.decision_ms : 0;
}

void dock_saved(dock_t *dock, bool written)
{
    if (written)
        dock->board.settings = DOCK_STORED_WHOLE;
    else
        link_say_words(&dock->link, MAV_SEVERITY_ERROR,
                       "settings could not be saved: flash fault");
    if (requests_saved(&dock->requests, written))
        link_answer_save(&dock->link, written);
}

void dock_led_duties(dock_t *dock, uint16_t duty[3], uint32_t now_ms)
{
    lamps_turn(&dock->lamps, now_ms);
    const look_lamps_t lamps = {lamps_are_lit(&dock->lamps, &dock->decision),
                                lamps_follow_water(&dock->lamps) &&
                                    !link_is_injecting(&dock->link)};
    look_turn(&dock->look, lamps, now_ms);
    if (look_is_on(&dock->look))
        led_dark(duty, &dock->settings.led);
    else
        lamps_duties(&dock->lamps, &dock->decision, &dock->settings.led, duty);
}
