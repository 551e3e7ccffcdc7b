#include <string.h>

#include "hsv.h"
#include "link_parts.h"

#define HEARTBEAT_MS 1000

/* The bits of DOCK_FAULT that are wrong now; an unlocked camera and the
 * dock's own light are none that the heartbeat would tell of. */
static uint16_t faults(const dock_t *dock)
{
    const dock_stored_t stored = dock->board.settings;
    const bool lost =
        stored == DOCK_STORED_LOST || stored == DOCK_STORED_IN_PART;
    return (uint16_t)((dock->camera_lost ? DOCK_FAULT_CAMERA : 0) |
                      (dock->decision.refused ? DOCK_FAULT_FRAME : 0) |
                      (lost ? DOCK_FAULT_SETTINGS : 0) |
                      (dock->requests.failed ? DOCK_FAULT_STORAGE : 0));
}

static bool send_heartbeat(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    mavlink_heartbeat_t heartbeat;
    memset(&heartbeat, 0, sizeof heartbeat);
    /* Generic rather than unknown: ground stations list its parameters. */
    heartbeat.type = MAV_TYPE_GENERIC;
    heartbeat.autopilot = MAV_AUTOPILOT_GENERIC;
    heartbeat.system_status =
        faults(dock) == 0 ? MAV_STATE_ACTIVE : MAV_STATE_CRITICAL;
    heartbeat.mavlink_version = 3;
    return MESSAGE_SEND(sender, HEARTBEAT, &heartbeat);
}

static bool send_version(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    mavlink_autopilot_version_t version;
    memset(&version, 0, sizeof version);
    version.capabilities = MAV_PROTOCOL_CAPABILITY_MAVLINK2 |
                           MAV_PROTOCOL_CAPABILITY_COMMAND_INT |
                           MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST;
    const uint64_t digest = METHOD_DIGEST;
    memcpy(version.middleware_custom_version, &digest, sizeof digest);
    version.uid = dock->board.uid;
    memcpy(version.flight_custom_version, dock->board.git_hash,
           sizeof version.flight_custom_version);
    return MESSAGE_SEND(sender, AUTOPILOT_VERSION, &version);
}

static void put_rgb(uint8_t to[3], rgb_t from)
{
    to[0] = from.red;
    to[1] = from.green;
    to[2] = from.blue;
}

static void fill_status(const dock_t *dock, uint32_t now_ms,
                        mavlink_dock_status_t *status)
{
    const decision_t *decision = &dock->decision;
    const background_t *b = &decision->background;
    memset(status, 0, sizeof *status);
    status->method_digest = METHOD_DIGEST;
    status->time_boot_ms = now_ms;
    status->frames = decision->frames;
    status->camera_faults = dock->camera_faults;
    status->frame_faults = decision->frame_faults;
    status->link_faults = dock->link.faults + dock->link.receiver.rejected;
    status->faults = faults(dock);
    if (dock->settings.camera.lock != 0 && !dock->camera.locked)
        status->faults |= DOCK_FAULT_UNLOCKED;
    if (!dock->look.clear)
        status->faults |= DOCK_FAULT_OWN_LIGHT;
    const bool stale = decision_is_stale(decision, now_ms);
    status->background_hue = b->meaningful && !stale ? b->hue : UINT16_MAX;
    status->decided_hue = decision->decided_hue;
    status->marker_hue = decision->steady.shown;
    uint16_t duty[3]; /* the message's own array may be unaligned */
    lamps_duties(&dock->lamps, decision, &dock->settings.led, duty);
    memcpy(status->duty, duty, sizeof duty);
    status->frame_rate_dhz = decision_rate_dhz(decision, now_ms);
    status->exposure = dock->camera.exposure;
    status->gain = dock->camera.gain;
    put_rgb(status->background_rgb,
            rgb_from_hsv(b->hue, b->saturation, b->value));
    status->confidence = stale ? 0 : b->confidence;
    status->led_mode = dock->lamps.mode;
    status->reset_reason = dock->board.reset_reason;
    status->sensor = dock->camera.sensor;
    status->lock = dock->camera.proven   ? DOCK_LOCK_PROVEN
                   : dock->camera.locked ? DOCK_LOCK_READ_BACK
                                         : DOCK_LOCK_NONE;
}

static bool send_status(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    mavlink_dock_status_t status;
    fill_status(dock, now_ms, &status);
    return MESSAGE_SEND(sender, DOCK_STATUS, &status);
}

/* Milliseconds from one to the next; 0 for one that is sent only when a host
 * asks for it. */
static uint32_t period_ms(const dock_t *dock, int report)
{
    const uint32_t wanted = dock->link.reports[report].period_ms;
    const uint32_t hertz = dock->settings.report_hz;
    if (wanted != 0)
        return wanted == REPORT_OFF ? 0 : wanted;
    switch (report) {
    case REPORT_HEARTBEAT:
        return HEARTBEAT_MS;
    case REPORT_STATUS:
        return hertz > 0 ? 1000 / hertz : 0;
    default:
        return 0;
    }
}

static bool send_interval(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    const int report = link_report_of(dock->link.interval_of);
    mavlink_message_interval_t interval;
    memset(&interval, 0, sizeof interval);
    interval.message_id = dock->link.interval_of;
    if (report >= 0) { /* 0 says that the dock does not send it */
        const uint32_t period = period_ms(dock, report);
        interval.interval_us = period == 0 ? -1 : (int32_t)(1000 * period);
    }
    return MESSAGE_SEND(sender, MESSAGE_INTERVAL, &interval);
}

/* In the order in which they go out. */
static const struct {
    uint32_t id;
    link_sender_t *send;
} reports[REPORTS] = {
    [REPORT_HEARTBEAT] = {MAVLINK_MSG_ID_HEARTBEAT, send_heartbeat},
    [REPORT_VERSION] = {MAVLINK_MSG_ID_AUTOPILOT_VERSION, send_version},
    [REPORT_STATUS] = {MAVLINK_MSG_ID_DOCK_STATUS, send_status},
    [REPORT_INTERVAL] = {MAVLINK_MSG_ID_MESSAGE_INTERVAL, send_interval},
};

int link_report_of(int64_t id)
{
    for (int i = 0; i < REPORTS; i++)
        if (reports[i].id == id)
            return i;
    return -1;
}

static bool is_due(const dock_t *dock, int report, uint32_t now_ms)
{
    const link_report_t *state = &dock->link.reports[report];
    const uint32_t period = period_ms(dock, report);
    switch (state->state) {
    case REPORT_NEVER_SENT:
        return period > 0;
    case REPORT_SENT:
        return period > 0 && now_ms - state->sent_ms >= period;
    case REPORT_DUE:
        break;
    }
    return true;
}

void link_ask_for_report(link_t *link, report_t report)
{
    link->reports[report].state = REPORT_DUE;
}

void link_ask_for_interval(link_t *link, uint16_t id)
{
    link->interval_of = id;
    link_ask_for_report(link, REPORT_INTERVAL);
}

void link_set_period(link_t *link, report_t report, uint32_t period)
{
    link->reports[report].period_ms = period;
}

bool link_send_reports(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    for (int i = 0; i < REPORTS; i++) {
        link_report_t *report = &dock->link.reports[i];
        if (!is_due(dock, i, now_ms))
            continue;
        report->state = REPORT_DUE;
        if (!reports[i].send(dock, sender, now_ms))
            return false;
        report->state = REPORT_SENT;
        report->sent_ms = now_ms;
    }
    return true;
}
