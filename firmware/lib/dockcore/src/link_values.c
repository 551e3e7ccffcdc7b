/* Parameters on their way out: which are due, in which message, and whose turn
 * it is. */
#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"

_Static_assert(PARAMETER_COUNT <= 32, "a bit each in link_turn_t");
_Static_assert((int)MAV_PARAM_EXT_TYPE_INT32 == MAV_PARAM_TYPE_INT32 &&
                   (int)MAV_PARAM_EXT_TYPE_REAL32 == MAV_PARAM_TYPE_REAL32,
               "put_value returns either");

/* The four bytes of a value as a float, or as a 32-bit integer where that is
 * wanted and the parameter has no fractions.  Returns the type. */
static uint8_t put_value(const dock_t *dock, uint16_t index, bool whole,
                         void *to)
{
    const parameter_t *parameter = &PARAMETERS[index];
    const int32_t stored = parameter_get(parameter, &dock->settings);
    const bool as_integer = whole && parameter->shift == 0;
    const uint32_t bits = as_integer ? (uint32_t)(stored * parameter->numerator)
                                     : parameter_to_real32(parameter, stored);
    memcpy(to, &bits, sizeof bits);
    return as_integer ? MAV_PARAM_TYPE_INT32 : MAV_PARAM_TYPE_REAL32;
}

static void put_name(uint16_t index, char to[16])
{
    memcpy(to, PARAMETERS[index].name, strlen(PARAMETERS[index].name));
}

static bool send_value(const dock_t *dock, uint16_t index, bool whole,
                       sender_t *sender)
{
    mavlink_param_value_t value;
    memset(&value, 0, sizeof value);
    put_name(index, value.param_id);
    value.param_type = put_value(dock, index, whole, &value.param_value);
    value.param_count = PARAMETER_COUNT;
    value.param_index = index;
    return MESSAGE_SEND(sender, PARAM_VALUE, &value);
}

static bool send_typed(const dock_t *dock, uint16_t index, sender_t *sender)
{
    mavlink_param_ext_value_t value;
    memset(&value, 0, sizeof value);
    put_name(index, value.param_id);
    value.param_type = put_value(dock, index, true, value.param_value);
    value.param_count = PARAMETER_COUNT;
    value.param_index = index;
    return MESSAGE_SEND(sender, PARAM_EXT_VALUE, &value);
}

static bool send_typed_ack(const dock_t *dock, uint16_t index, sender_t *sender)
{
    mavlink_param_ext_ack_t ack;
    memset(&ack, 0, sizeof ack);
    put_name(index, ack.param_id);
    ack.param_type = put_value(dock, index, true, ack.param_value);
    ack.param_result = (dock->link.parameters.refused >> index & 1) != 0
                           ? PARAM_ACK_VALUE_UNSUPPORTED
                           : PARAM_ACK_ACCEPTED;
    return MESSAGE_SEND(sender, PARAM_EXT_ACK, &ack);
}

static bool send_one(const dock_t *dock, value_form_t form, uint16_t index,
                     sender_t *sender)
{
    switch (form) {
    case VALUE_TYPED:
        return send_typed(dock, index, sender);
    case VALUE_TYPED_ACK:
        return send_typed_ack(dock, index, sender);
    default:
        return send_value(dock, index, form == VALUE_WHOLE, sender);
    }
}

void link_values_due(link_t *link, value_form_t form, uint32_t which)
{
    link->parameters.turns[form].due |=
        which & (uint32_t)((UINT64_C(1) << PARAMETER_COUNT) - 1);
}

/* Begins where it stopped: whoever asks for all of them again and again, on a
 * slow line, gets the last ones too. */
static bool send_in_turn(dock_t *dock, value_form_t form, sender_t *sender)
{
    link_turn_t *turn = &dock->link.parameters.turns[form];
    for (; turn->due != 0;
         turn->next = (uint8_t)((turn->next + 1) % PARAMETER_COUNT)) {
        const uint32_t bit = UINT32_C(1) << turn->next;
        if ((turn->due & bit) == 0)
            continue;
        if (!send_one(dock, form, turn->next, sender))
            return false;
        turn->due &= ~bit;
    }
    turn->next = 0;
    return true;
}

bool link_send_values(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    for (int form = 0; form < VALUE_FORMS; form++)
        if (!send_in_turn(dock, (value_form_t)form, sender))
            return false;
    return true;
}
