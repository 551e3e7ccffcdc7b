#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"

_Static_assert(PARAMETER_COUNT <= 32, "a bit each in parameters_due");
#define ALL_PARAMETERS ((uint32_t)((UINT64_C(1) << PARAMETER_COUNT) - 1))
#define NAME_LENGTH 16

/* Index by name, which has no zero at its end if it is 16 letters long; or -1.
 */
static int find(const char name[NAME_LENGTH])
{
    for (int i = 0; i < PARAMETER_COUNT; i++)
        if (strncmp(PARAMETERS[i].name, name, NAME_LENGTH) == 0)
            return i;
    return -1;
}

static void add_shown(line_t *line, const parameter_t *parameter,
                      int32_t stored)
{
    line_add_fixed(line, (int64_t)stored * parameter->numerator,
                   parameter->shift);
}

static void refuse_name(dock_t *dock, const char name[NAME_LENGTH])
{
    char words[NAME_LENGTH + 1];
    memcpy(words, name, NAME_LENGTH);
    words[NAME_LENGTH] = '\0';
    line_t line = {{0}, 0};
    line_add(&line, words);
    line_add(&line, ": no such parameter");
    link_say(&dock->link, MAV_SEVERITY_WARNING, &line);
    link_count_fault(&dock->link);
}

static void refuse_index(dock_t *dock, int index)
{
    line_t line = {{0}, 0};
    line_add(&line, "parameter ");
    line_add_fixed(&line, index, 0);
    line_add(&line, ": no such parameter");
    link_say(&dock->link, MAV_SEVERITY_WARNING, &line);
    link_count_fault(&dock->link);
}

static void refuse_value(dock_t *dock, const parameter_t *parameter)
{
    line_t line = {{0}, 0};
    line_add(&line, parameter->name);
    line_add(&line, " refused: allowed ");
    add_shown(&line, parameter, parameter->minimum);
    line_add(&line, " to ");
    add_shown(&line, parameter, parameter->maximum);
    link_say(&dock->link, MAV_SEVERITY_WARNING, &line);
    link_count_fault(&dock->link);
}

void link_on_parameter_list(dock_t *dock, const received_t *message,
                            uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_request_list_t request;
    message_read(&request, sizeof request, message);
    if (link_is_for_us(request.target_system, request.target_component))
        dock->link.parameters_due = ALL_PARAMETERS;
}

void link_on_parameter_read(dock_t *dock, const received_t *message,
                            uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_request_read_t request;
    message_read(&request, sizeof request, message);
    if (!link_is_for_us(request.target_system, request.target_component))
        return;
    const int index =
        request.param_index >= 0 ? request.param_index : find(request.param_id);
    if (index < 0)
        refuse_name(dock, request.param_id);
    else if (index < PARAMETER_COUNT)
        dock->link.parameters_due |= UINT32_C(1) << index;
    else
        refuse_index(dock, index);
}

static bool same_camera(const camera_settings_t *a, const camera_settings_t *b)
{
    return a->lock == b->lock && a->exposure == b->exposure &&
           a->gain == b->gain && a->white_balance == b->white_balance;
}

/* After any change of the settings: what follows from it. */
static void settings_changed(dock_t *dock, const dock_settings_t *before)
{
    if (!same_camera(&before->camera, &dock->settings.camera))
        requests_camera(&dock->requests);
    lamps_follow(&dock->lamps, before, &dock->settings);
    decision_follow(&dock->decision, before, &dock->settings);
}

void link_reset_parameters(dock_t *dock)
{
    const dock_settings_t before = dock->settings;
    dock->settings = dock_reset_settings(&before);
    settings_changed(dock, &before);
    dock->link.parameters_due = ALL_PARAMETERS;
}

void link_on_parameter_set(dock_t *dock, const received_t *message,
                           uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_set_t request;
    message_read(&request, sizeof request, message);
    if (!link_is_for_us(request.target_system, request.target_component))
        return;
    const int index = find(request.param_id);
    if (index < 0) {
        refuse_name(dock, request.param_id);
        return;
    }
    const dock_settings_t before = dock->settings;
    uint32_t bits;
    int32_t stored;
    memcpy(&bits, &request.param_value, sizeof bits);
    if (!parameter_from_real32(&PARAMETERS[index], bits, &stored) ||
        !parameter_set(&PARAMETERS[index], &dock->settings, stored))
        refuse_value(dock, &PARAMETERS[index]);
    settings_changed(dock, &before);
    /* The value as it is now, refused or not: that is the answer. */
    dock->link.parameters_due |= UINT32_C(1) << index;
}

bool link_send_parameters(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    for (uint16_t i = 0; i < PARAMETER_COUNT; i++) {
        const uint32_t bit = UINT32_C(1) << i;
        if ((dock->link.parameters_due & bit) == 0)
            continue;
        mavlink_param_value_t value;
        memset(&value, 0, sizeof value);
        const uint32_t shown = parameter_to_real32(
            &PARAMETERS[i], parameter_get(&PARAMETERS[i], &dock->settings));
        memcpy(&value.param_value, &shown, sizeof shown);
        memcpy(value.param_id, PARAMETERS[i].name, strlen(PARAMETERS[i].name));
        value.param_type = MAV_PARAM_TYPE_REAL32;
        value.param_count = PARAMETER_COUNT;
        value.param_index = i;
        if (!MESSAGE_SEND(sender, PARAM_VALUE, &value))
            return false;
        dock->link.parameters_due &= ~bit;
    }
    return true;
}
