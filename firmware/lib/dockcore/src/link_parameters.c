#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"
#include "real32.h"

_Static_assert(PARAMETER_COUNT <= 32, "a bit each in parameters_due");
#define ALL_PARAMETERS ((uint32_t)((UINT64_C(1) << PARAMETER_COUNT) - 1))
#define NAME_LENGTH 16
#define NOT_A_NUMBER UINT32_C(0x7FC00000)

/* Index by name, which has no zero at its end if it is 16 letters long; or -1.
 */
int link_find_parameter(const char name[NAME_LENGTH])
{
    for (int i = 0; i < PARAMETER_COUNT; i++)
        if (strncmp(PARAMETERS[i].name, name, NAME_LENGTH) == 0)
            return i;
    return -1;
}

/* The number that a PARAM_SET carries, as bits of an IEEE 754 one.  Some hosts
 * cast every value to a float; others put an integer's own bytes there and say
 * so by its type.  The two cannot be confused: an integer below 2^23, more than
 * any parameter needs, has the bytes of a float that is subnormal or none, and
 * no integer's float is either. */
static uint32_t number_of(uint32_t bits, uint8_t type)
{
    const uint32_t exponent = bits >> 23 & 0xFF;
    if (exponent != 0 && exponent != 0xFF)
        return bits;
    switch (type) {
    case MAV_PARAM_TYPE_UINT8:
        return real32_from_fixed((uint8_t)bits, 0);
    case MAV_PARAM_TYPE_INT8:
        return real32_from_fixed((int8_t)bits, 0);
    case MAV_PARAM_TYPE_UINT16:
        return real32_from_fixed((uint16_t)bits, 0);
    case MAV_PARAM_TYPE_INT16:
        return real32_from_fixed((int16_t)bits, 0);
    case MAV_PARAM_TYPE_UINT32:
        return real32_from_fixed(bits, 0);
    case MAV_PARAM_TYPE_INT32:
        return real32_from_fixed((int32_t)bits, 0);
    default:
        /* A subnormal number was an integer too, and would count as zero. */
        return bits << 1 == 0 || exponent != 0 ? bits : NOT_A_NUMBER;
    }
}

static void add_shown(line_t *line, const parameter_t *parameter,
                      int32_t stored)
{
    line_add_fixed(line, (int64_t)stored * parameter->numerator,
                   parameter->shift);
}

/* The beginning of a text about a name that came over the link. */
static line_t line_about(const char name[NAME_LENGTH])
{
    char words[NAME_LENGTH + 1];
    memcpy(words, name, NAME_LENGTH);
    words[NAME_LENGTH] = '\0';
    line_t line = {{0}, 0};
    line_add(&line, words);
    return line;
}

/* Ground stations ask for names that they know of other systems: no fault. */
static void say_unknown(dock_t *dock, line_t *line)
{
    line_add(line, ": no such parameter");
    link_say(&dock->link, MAV_SEVERITY_WARNING, line);
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
    if (link_is_for_us(&dock->link, request.target_system,
                       request.target_component))
        dock->link.parameters_due = ALL_PARAMETERS;
}

void link_on_parameter_read(dock_t *dock, const received_t *message,
                            uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_request_read_t request;
    message_read(&request, sizeof request, message);
    if (!link_is_for_us(&dock->link, request.target_system,
                        request.target_component))
        return;
    const int index = request.param_index >= 0
                          ? request.param_index
                          : link_find_parameter(request.param_id);
    if (index >= 0 && index < PARAMETER_COUNT) {
        dock->link.parameters_due |= UINT32_C(1) << index;
        return;
    }
    line_t line = {{0}, 0};
    if (index < 0) {
        line = line_about(request.param_id);
    } else {
        line_add(&line, "parameter ");
        line_add_fixed(&line, index, 0);
    }
    say_unknown(dock, &line);
}

static bool same_camera(const camera_settings_t *a, const camera_settings_t *b)
{
    return a->lock == b->lock && a->exposure == b->exposure &&
           a->gain == b->gain && a->white_balance == b->white_balance;
}

/* What follows from a change of the settings. */
static void follow_camera(dock_t *dock, const dock_settings_t *before)
{
    if (!same_camera(&before->camera, &dock->settings.camera))
        requests_camera(&dock->requests);
}

/* Whoever sets one of these means it, whatever it was before: a test of the
 * LEDs ends, an interval that a host asked for gives way. */
static void follow_set(dock_t *dock, int index)
{
    if (index == PARAMETER_LED_MODE || index == PARAMETER_LED_HUE)
        lamps_follow(&dock->lamps, &dock->settings);
    if (index == PARAMETER_REPORT_HZ)
        link_set_period(&dock->link, REPORT_STATUS, 0);
}

void link_reset_parameters(dock_t *dock)
{
    const dock_settings_t before = dock->settings;
    dock->settings = dock_default_settings();
    follow_camera(dock, &before);
    for (int i = 0; i < PARAMETER_COUNT; i++)
        follow_set(dock, i);
    dock->link.parameters_due = ALL_PARAMETERS;
}

bool link_set_parameter(dock_t *dock, int index, uint32_t bits)
{
    const dock_settings_t before = dock->settings;
    int32_t stored;
    if (!parameter_from_real32(&PARAMETERS[index], bits, &stored) ||
        !parameter_set(&PARAMETERS[index], &dock->settings, stored)) {
        refuse_value(dock, &PARAMETERS[index]);
        return false;
    }
    follow_camera(dock, &before);
    follow_set(dock, index);
    return true;
}

/* A message to every system is not for this one's settings. */
static bool is_for_this_dock(const link_t *link, uint8_t system,
                             uint8_t component)
{
    return system != 0 && link_is_for_us(link, system, component);
}

void link_on_parameter_set(dock_t *dock, const received_t *message,
                           uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_set_t request;
    message_read(&request, sizeof request, message);
    if (!is_for_this_dock(&dock->link, request.target_system,
                          request.target_component))
        return;
    const int index = link_find_parameter(request.param_id);
    if (index < 0) {
        line_t line = line_about(request.param_id);
        say_unknown(dock, &line);
        link_count_fault(&dock->link);
        return;
    }
    uint32_t bits;
    memcpy(&bits, &request.param_value, sizeof bits);
    link_set_parameter(dock, index, number_of(bits, request.param_type));
    /* The value as it is now, refused or not: that is the answer. */
    dock->link.parameters_due |= UINT32_C(1) << index;
}

static bool send_value(const dock_t *dock, uint16_t index, sender_t *sender)
{
    const parameter_t *parameter = &PARAMETERS[index];
    const uint32_t shown = parameter_to_real32(
        parameter, parameter_get(parameter, &dock->settings));
    mavlink_param_value_t value;
    memset(&value, 0, sizeof value);
    memcpy(&value.param_value, &shown, sizeof shown);
    memcpy(value.param_id, parameter->name, strlen(parameter->name));
    value.param_type = MAV_PARAM_TYPE_REAL32;
    value.param_count = PARAMETER_COUNT;
    value.param_index = index;
    return MESSAGE_SEND(sender, PARAM_VALUE, &value);
}

/* In turn, beginning where it stopped: whoever asks for all of them again and
 * again, on a slow line, gets the last ones too. */
bool link_send_parameters(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    link_t *link = &dock->link;
    for (; link->parameters_due != 0;
         link->next_parameter =
             (uint8_t)((link->next_parameter + 1) % PARAMETER_COUNT)) {
        const uint32_t bit = UINT32_C(1) << link->next_parameter;
        if ((link->parameters_due & bit) == 0)
            continue;
        if (!send_value(dock, link->next_parameter, sender))
            return false;
        link->parameters_due &= ~bit;
    }
    link->next_parameter = 0;
    return true;
}
