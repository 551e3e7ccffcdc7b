#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"
#include "real32.h"

#define SIGN (UINT32_C(1) << 31) /* alone: minus zero */

/* An argument that is a whole number, 0 or more; -1 for any other. */
static int64_t whole(const float *argument)
{
    uint32_t bits;
    int64_t n;
    memcpy(&bits, argument, sizeof bits);
    return real32_to_fixed(bits, 0, &n) && n >= 0 &&
                   real32_from_fixed(n, 0) == (bits == SIGN ? 0 : bits)
               ? n
               : -1;
}

/* A hue in degrees, 0..360, as hue steps; -1 for anything else. */
static int32_t hue_of_degrees(const float *argument)
{
    uint32_t bits;
    int32_t hue;
    memcpy(&bits, argument, sizeof bits);
    if (!parameter_from_real32(&PARAMETERS[PARAMETER_LED_HUE], bits, &hue) ||
        hue < 0 || hue > METHOD_HUE_RANGE)
        return -1;
    return hue % METHOD_HUE_RANGE;
}

static uint8_t show_hue(lamps_t *lamps, const mavlink_command_long_t *command)
{
    const int32_t hue = hue_of_degrees(&command->param2);
    if (hue < 0)
        return MAV_RESULT_DENIED;
    lamps_show_hue(lamps, (uint16_t)hue);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t show_raw(lamps_t *lamps, const mavlink_command_long_t *command)
{
    const int64_t rgb[3] = {whole(&command->param2), whole(&command->param3),
                            whole(&command->param4)};
    uint8_t raw[3];
    for (int i = 0; i < 3; i++) {
        if (rgb[i] < 0 || rgb[i] > 255)
            return MAV_RESULT_DENIED;
        raw[i] = (uint8_t)rgb[i];
    }
    lamps_show_raw(lamps, raw);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t set_leds(lamps_t *lamps, const mavlink_command_long_t *command)
{
    switch (whole(&command->param1)) {
    case DOCK_LED_AUTO:
        lamps_show_marker(lamps);
        return MAV_RESULT_ACCEPTED;
    case DOCK_LED_HUE:
        return show_hue(lamps, command);
    case DOCK_LED_RAW:
        return show_raw(lamps, command);
    default:
        return MAV_RESULT_DENIED;
    }
}

static uint8_t store(dock_t *dock, const mavlink_command_long_t *command,
                     const link_ack_t *ack)
{
    switch (whole(&command->param1)) {
    case 1: /* write */
        if (!requests_save(&dock->requests))
            return MAV_RESULT_TEMPORARILY_REJECTED;
        link_answer_save_later(&dock->link, ack);
        return MAV_RESULT_IN_PROGRESS;
    case 2: /* back to the defaults; not yet in flash */
        link_reset_parameters(dock);
        return MAV_RESULT_ACCEPTED;
    default:
        return MAV_RESULT_DENIED;
    }
}

static uint8_t reboot(dock_t *dock, const mavlink_command_long_t *command)
{
    if (whole(&command->param1) != 1)
        return MAV_RESULT_DENIED;
    requests_reboot(&dock->requests);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t request_message(dock_t *dock,
                               const mavlink_command_long_t *command)
{
    switch (whole(&command->param1)) {
    case MAVLINK_MSG_ID_AUTOPILOT_VERSION:
        link_ask_for_report(&dock->link, REPORT_VERSION);
        return MAV_RESULT_ACCEPTED;
    case MAVLINK_MSG_ID_DOCK_STATUS:
        link_ask_for_report(&dock->link, REPORT_STATUS);
        return MAV_RESULT_ACCEPTED;
    default:
        return MAV_RESULT_DENIED;
    }
}

static uint8_t snapshot(dock_t *dock)
{
    if (dock->board.buffer == NULL)
        return MAV_RESULT_UNSUPPORTED;
    return link_want_snapshot(dock) ? MAV_RESULT_ACCEPTED
                                    : MAV_RESULT_TEMPORARILY_REJECTED;
}

static uint8_t obey(dock_t *dock, const mavlink_command_long_t *command,
                    const link_ack_t *ack)
{
    switch (command->command) {
    case MAV_CMD_DOCK_LED:
        return set_leds(&dock->lamps, command);
    case MAV_CMD_DOCK_SNAPSHOT:
        return snapshot(dock);
    case MAV_CMD_PREFLIGHT_STORAGE:
        return store(dock, command, ack);
    case MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN:
        return reboot(dock, command);
    case MAV_CMD_REQUEST_MESSAGE:
        return request_message(dock, command);
    case MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES:
        link_ask_for_report(&dock->link, REPORT_VERSION);
        return MAV_RESULT_ACCEPTED;
    default:
        return MAV_RESULT_UNSUPPORTED;
    }
}

void link_on_command(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    (void)now_ms;
    mavlink_command_long_t command;
    message_read(&command, sizeof command, message);
    if (!link_is_for_us(command.target_system, command.target_component))
        return;
    link_ack_t ack = {command.command, MAV_RESULT_ACCEPTED, message->system,
                      message->component};
    ack.result = obey(dock, &command, &ack);
    if (ack.result == MAV_RESULT_DENIED)
        link_count_fault(&dock->link);
    if (ack.result != MAV_RESULT_IN_PROGRESS) /* that one is answered later */
        link_acknowledge(&dock->link, &ack);
}
