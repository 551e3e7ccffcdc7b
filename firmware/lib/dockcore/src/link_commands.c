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

static uint8_t set_leds(dock_t *dock, const mavlink_command_long_t *command)
{
    const int64_t rgb[3] = {whole(&command->param2), whole(&command->param3),
                            whole(&command->param4)};
    const int32_t hue = hue_of_degrees(&command->param2);
    switch (whole(&command->param1)) {
    case DOCK_LED_AUTO:
        break;
    case DOCK_LED_HUE:
        if (hue < 0)
            return MAV_RESULT_DENIED;
        dock->led_hue = (uint16_t)hue;
        break;
    case DOCK_LED_RAW:
        for (int i = 0; i < 3; i++)
            if (rgb[i] < 0 || rgb[i] > 255)
                return MAV_RESULT_DENIED;
        for (int i = 0; i < 3; i++)
            dock->led_raw[i] = (uint8_t)rgb[i];
        break;
    default:
        return MAV_RESULT_DENIED;
    }
    dock->led_mode = (uint8_t)whole(&command->param1);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t store(dock_t *dock, const mavlink_command_long_t *command,
                     const link_ack_t *ack)
{
    const dock_settings_t before = dock->settings;
    switch (whole(&command->param1)) {
    case 1: /* write */
        if (dock->link.saving)
            return MAV_RESULT_TEMPORARILY_REJECTED;
        dock->requests |= 1u << DOCK_REQUEST_SAVE;
        dock->link.save_ack = *ack;
        dock->link.saving = true;
        return MAV_RESULT_IN_PROGRESS;
    case 2: /* back to the defaults; not yet in flash */
        dock->settings = dock_reset_settings(&before);
        link_settings_changed(dock, &before);
        link_report_parameters(dock);
        return MAV_RESULT_ACCEPTED;
    default:
        return MAV_RESULT_DENIED;
    }
}

static uint8_t reboot(dock_t *dock, const mavlink_command_long_t *command)
{
    if (whole(&command->param1) != 1)
        return MAV_RESULT_DENIED;
    dock->requests |= 1u << DOCK_REQUEST_REBOOT;
    return MAV_RESULT_ACCEPTED;
}

static uint8_t request_message(dock_t *dock,
                               const mavlink_command_long_t *command)
{
    switch (whole(&command->param1)) {
    case MAVLINK_MSG_ID_AUTOPILOT_VERSION:
        dock->link.version_due = true;
        return MAV_RESULT_ACCEPTED;
    case MAVLINK_MSG_ID_DOCK_STATUS:
        dock->link.status_due = true;
        return MAV_RESULT_ACCEPTED;
    default:
        return MAV_RESULT_DENIED;
    }
}

static uint8_t snapshot(dock_t *dock)
{
    if (dock->board.buffer == NULL)
        return MAV_RESULT_UNSUPPORTED;
    if (!link_can_snapshot(dock))
        return MAV_RESULT_TEMPORARILY_REJECTED;
    dock->link.snapshot_wanted = true;
    return MAV_RESULT_ACCEPTED;
}

static uint8_t obey(dock_t *dock, const mavlink_command_long_t *command,
                    const link_ack_t *ack)
{
    switch (command->command) {
    case MAV_CMD_DOCK_LED:
        return set_leds(dock, command);
    case MAV_CMD_DOCK_SNAPSHOT:
        return snapshot(dock);
    case MAV_CMD_PREFLIGHT_STORAGE:
        return store(dock, command, ack);
    case MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN:
        return reboot(dock, command);
    case MAV_CMD_REQUEST_MESSAGE:
        return request_message(dock, command);
    case MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES:
        dock->link.version_due = true;
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
        dock->link.faults++;
    if (ack.result != MAV_RESULT_IN_PROGRESS) /* that one is answered later */
        link_acknowledge(dock, &ack);
}

/* An answer that finds no room is dropped: the host asks again. */
void link_acknowledge(dock_t *dock, const link_ack_t *ack)
{
    link_t *link = &dock->link;
    if (link->ack_count < LINK_ACKS)
        link->acks[link->ack_count++] = *ack;
}

bool link_send_acks(dock_t *dock, sender_t *sender)
{
    link_t *link = &dock->link;
    while (link->ack_count > 0) {
        const link_ack_t *ack = &link->acks[0];
        mavlink_command_ack_t answer;
        memset(&answer, 0, sizeof answer);
        answer.command = ack->command;
        answer.result = ack->result;
        answer.target_system = ack->system;
        answer.target_component = ack->component;
        if (!MESSAGE_SEND(sender, COMMAND_ACK, &answer))
            return false;
        memmove(link->acks, link->acks + 1,
                --link->ack_count * sizeof link->acks[0]);
    }
    return true;
}
