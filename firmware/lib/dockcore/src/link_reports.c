#include <string.h>

#include "hsv.h"
#include "link_parts.h"

#define HEARTBEAT_MS 1000

static bool send_heartbeat(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    link_t *link = &dock->link;
    if (link->heartbeat_sent && now_ms - link->heartbeat_ms < HEARTBEAT_MS)
        return true;
    mavlink_heartbeat_t heartbeat;
    memset(&heartbeat, 0, sizeof heartbeat);
    /* Generic rather than unknown: ground stations list its parameters. */
    heartbeat.type = MAV_TYPE_GENERIC;
    heartbeat.autopilot = MAV_AUTOPILOT_GENERIC;
    heartbeat.system_status =
        dock->faults == 0 ? MAV_STATE_ACTIVE : MAV_STATE_CRITICAL;
    heartbeat.mavlink_version = 3;
    if (!MESSAGE_SEND(sender, HEARTBEAT, &heartbeat))
        return false;
    link->heartbeat_sent = true;
    link->heartbeat_ms = now_ms;
    return true;
}

static bool send_version(dock_t *dock, sender_t *sender)
{
    if (!dock->link.version_due)
        return true;
    mavlink_autopilot_version_t version;
    memset(&version, 0, sizeof version);
    version.capabilities = MAV_PROTOCOL_CAPABILITY_MAVLINK2 |
                           MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST;
    const uint64_t digest = METHOD_DIGEST;
    memcpy(version.middleware_custom_version, &digest, sizeof digest);
    memcpy(version.flight_custom_version, dock->board.git_hash,
           sizeof version.flight_custom_version);
    if (!MESSAGE_SEND(sender, AUTOPILOT_VERSION, &version))
        return false;
    dock->link.version_due = false;
    return true;
}

static void put_rgb(uint8_t to[3], rgb_t from)
{
    to[0] = from.red;
    to[1] = from.green;
    to[2] = from.blue;
}

static uint16_t frame_rate_dhz(const dock_t *dock)
{
    if (dock->frame_period_q8 == 0)
        return 0;
    const uint32_t rate = UINT32_C(10000) * 256 / dock->frame_period_q8;
    return (uint16_t)(rate < UINT16_MAX ? rate : UINT16_MAX);
}

static void fill_status(const dock_t *dock, uint32_t now_ms,
                        mavlink_dock_status_t *status)
{
    const background_t *b = &dock->background;
    memset(status, 0, sizeof *status);
    status->method_digest = METHOD_DIGEST;
    status->time_boot_ms = now_ms;
    status->frames = dock->counters.frames;
    status->camera_faults = dock->counters.camera_faults;
    status->frame_faults = dock->counters.frame_faults;
    status->link_faults = dock->link.faults + dock->link.receiver.rejected;
    status->faults = dock->faults;
    if (dock->settings.camera.lock != 0 && !dock->camera.locked)
        status->faults |= DOCK_FAULT_UNLOCKED;
    status->background_hue = b->meaningful ? b->hue : UINT16_MAX;
    status->decided_hue = dock->decided_hue;
    status->marker_hue = dock->marker_hue;
    uint16_t duty[3]; /* the message's own array may be unaligned */
    dock_led_duties(dock, duty);
    memcpy(status->duty, duty, sizeof duty);
    status->frame_rate_dhz = frame_rate_dhz(dock);
    status->exposure = dock->camera.exposure;
    status->gain = dock->camera.gain;
    put_rgb(status->background_rgb,
            rgb_from_hsv(b->hue, b->saturation, b->value));
    status->confidence = b->confidence;
    status->led_mode = dock->led_mode;
    status->reset_reason = dock->board.reset_reason;
}

static bool send_status(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    link_t *link = &dock->link;
    const uint32_t rate = dock->settings.report_hz;
    if (rate > 0 &&
        (!link->status_sent || now_ms - link->status_ms >= 1000 / rate))
        link->status_due = true;
    if (!link->status_due)
        return true;
    mavlink_dock_status_t status;
    fill_status(dock, now_ms, &status);
    if (!MESSAGE_SEND(sender, DOCK_STATUS, &status))
        return false;
    link->status_sent = true;
    link->status_due = false;
    link->status_ms = now_ms;
    return true;
}

bool link_send_reports(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    return send_heartbeat(dock, sender, now_ms) && send_version(dock, sender) &&
           send_status(dock, sender, now_ms);
}
