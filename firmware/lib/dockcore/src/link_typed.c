/* MAVLink's extended parameter protocol: each value has its own type.  For
 * hosts that want integers, such as MAVSDK; the other protocol has but floats.
 */
#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"

_Static_assert((int)MAV_PARAM_EXT_TYPE_INT32 == MAV_PARAM_TYPE_INT32 &&
                   (int)MAV_PARAM_EXT_TYPE_UINT8 == MAV_PARAM_TYPE_UINT8,
               "link_integer_of takes either");

/* Whole numbers travel as 32-bit integers, fractions as floats: the four bytes,
 * and the type. */
static uint8_t put_value(const dock_t *dock, uint16_t index, char to[128])
{
    const parameter_t *parameter = &PARAMETERS[index];
    const int32_t stored = parameter_get(parameter, &dock->settings);
    const bool whole = parameter->shift == 0;
    const uint32_t bits = whole ? (uint32_t)(stored * parameter->numerator)
                                : parameter_to_real32(parameter, stored);
    memcpy(to, &bits, sizeof bits);
    return whole ? MAV_PARAM_EXT_TYPE_INT32 : MAV_PARAM_EXT_TYPE_REAL32;
}

static void put_name(uint16_t index, char to[16])
{
    memcpy(to, PARAMETERS[index].name, strlen(PARAMETERS[index].name));
}

static bool send_value(const dock_t *dock, uint16_t index, sender_t *sender)
{
    mavlink_param_ext_value_t value;
    memset(&value, 0, sizeof value);
    put_name(index, value.param_id);
    value.param_type = put_value(dock, index, value.param_value);
    value.param_count = PARAMETER_COUNT;
    value.param_index = index;
    return MESSAGE_SEND(sender, PARAM_EXT_VALUE, &value);
}

static bool send_answer(const dock_t *dock, uint16_t index, sender_t *sender)
{
    mavlink_param_ext_ack_t ack;
    memset(&ack, 0, sizeof ack);
    put_name(index, ack.param_id);
    ack.param_type = put_value(dock, index, ack.param_value);
    ack.param_result = (dock->link.typed.refused >> index & 1) != 0
                           ? PARAM_ACK_VALUE_UNSUPPORTED
                           : PARAM_ACK_ACCEPTED;
    return MESSAGE_SEND(sender, PARAM_EXT_ACK, &ack);
}

void link_on_typed_list(dock_t *dock, const received_t *message,
                        uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_ext_request_list_t request;
    message_read(&request, sizeof request, message);
    if (link_is_for_us(&dock->link, request.target_system,
                       request.target_component))
        link_turn_all(&dock->link.typed.values);
}

void link_on_typed_read(dock_t *dock, const received_t *message,
                        uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_ext_request_read_t request;
    message_read(&request, sizeof request, message);
    if (!link_is_for_us(&dock->link, request.target_system,
                        request.target_component))
        return;
    const int index = link_asked_parameter(&dock->link, request.param_index,
                                           request.param_id);
    if (index >= 0)
        link_turn_one(&dock->link.typed.values, index);
}

void link_on_typed_set(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    (void)now_ms;
    link_typed_t *typed = &dock->link.typed;
    mavlink_param_ext_set_t request;
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
    memcpy(&bits, request.param_value, sizeof bits);
    if (request.param_type != MAV_PARAM_EXT_TYPE_REAL32)
        bits = link_integer_of(bits, request.param_type);
    const uint32_t bit = UINT32_C(1) << index;
    if (link_set_parameter(dock, index, bits))
        typed->refused &= ~bit;
    else
        typed->refused |= bit;
    link_turn_one(&typed->answers, index);
}

bool link_send_typed(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    link_typed_t *typed = &dock->link.typed;
    return link_send_in_turn(dock, &typed->answers, sender, send_answer) &&
           link_send_in_turn(dock, &typed->values, sender, send_value);
}
