/* MAVLink's parameter protocol: all values travel as floats. */
#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"
#include "real32.h"

_Static_assert(PARAMETER_COUNT <= 32, "a bit each in link_turn_t");
#define ALL_PARAMETERS ((uint32_t)((UINT64_C(1) << PARAMETER_COUNT) - 1))
#define NOT_A_NUMBER UINT32_C(0x7FC00000)

uint32_t link_integer_of(uint32_t bits, uint8_t type)
{
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
        return NOT_A_NUMBER;
    }
}

/* The number that a PARAM_SET carries, as bits of an IEEE 754 one.  Some hosts
 * cast every value to a float; others put an integer's own bytes there and say
 * so by its type.  The two cannot be confused: an integer below 2^23, more than
 * any parameter needs, has the bytes of a float that is subnormal or none, and
 * no integer's float is either.  Bytes like that without an integer's type are
 * refused: as a float they would count as zero. */
static uint32_t number_of(uint32_t bits, uint8_t type)
{
    const uint32_t exponent = bits >> 23 & 0xFF;
    const bool zero = bits << 1 == 0;
    if (zero || (exponent != 0 && exponent != 0xFF))
        return bits;
    return link_integer_of(bits, type);
}

void link_turn_all(link_turn_t *turn)
{
    turn->due = ALL_PARAMETERS;
}

void link_turn_one(link_turn_t *turn, int index)
{
    turn->due |= UINT32_C(1) << index;
}

/* Begins where it stopped: whoever asks for all of them again and again, on a
 * slow line, gets the last ones too. */
bool link_send_in_turn(dock_t *dock, link_turn_t *turn, sender_t *sender,
                       link_send_one_t *send_one)
{
    for (; turn->due != 0;
         turn->next = (uint8_t)((turn->next + 1) % PARAMETER_COUNT)) {
        const uint32_t bit = UINT32_C(1) << turn->next;
        if ((turn->due & bit) == 0)
            continue;
        if (!send_one(dock, turn->next, sender))
            return false;
        turn->due &= ~bit;
    }
    turn->next = 0;
    return true;
}

void link_reset_parameters(dock_t *dock)
{
    link_reset_settings(dock);
    link_turn_all(&dock->link.parameters);
}

void link_on_parameter_list(dock_t *dock, const received_t *message,
                            uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_request_list_t request;
    message_read(&request, sizeof request, message);
    if (link_is_for_us(&dock->link, request.target_system,
                       request.target_component))
        link_turn_all(&dock->link.parameters);
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
    const int index = link_asked_parameter(&dock->link, request.param_index,
                                           request.param_id);
    if (index >= 0)
        link_turn_one(&dock->link.parameters, index);
}

void link_on_parameter_set(dock_t *dock, const received_t *message,
                           uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_set_t request;
    message_read(&request, sizeof request, message);
    if (!link_is_for_this(&dock->link, request.target_system,
                          request.target_component))
        return;
    const int index = link_find_parameter(&dock->link, request.param_id);
    if (index < 0) {
        link_count_fault(&dock->link);
        return;
    }
    uint32_t bits;
    memcpy(&bits, &request.param_value, sizeof bits);
    link_set_parameter(dock, index, number_of(bits, request.param_type));
    /* The value as it is now, refused or not: that is the answer. */
    link_turn_one(&dock->link.parameters, index);
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

bool link_send_parameters(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    return link_send_in_turn(dock, &dock->link.parameters, sender, send_value);
}
