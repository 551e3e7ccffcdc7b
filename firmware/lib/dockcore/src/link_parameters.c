/* MAVLink's two parameter protocols: what a host asks for and sets.  In the
 * first one a value is four bytes, a float or an integer; the extended one says
 * of each value which it is. */
#include <stddef.h>
#include <string.h>

#include "link_parts.h"
#include "real32.h"

#define NOT_A_NUMBER UINT32_C(0x7FC00000)

/* The system number that MAVSDK takes unless its user gives it another.  Its
 * set_param_int and get_param_int read a parameter first and go on only where
 * the answer is an integer; see link.md. */
#define MAVSDK_SYSTEM 245

_Static_assert(sizeof(mavlink_param_request_list_t) ==
                       sizeof(mavlink_param_ext_request_list_t) &&
                   sizeof(mavlink_param_request_read_t) ==
                       sizeof(mavlink_param_ext_request_read_t) &&
                   offsetof(mavlink_param_request_read_t, param_id) ==
                       offsetof(mavlink_param_ext_request_read_t, param_id),
               "both protocols ask in the same way");
_Static_assert((int)MAV_PARAM_EXT_TYPE_INT32 == MAV_PARAM_TYPE_INT32 &&
                   (int)MAV_PARAM_EXT_TYPE_UINT8 == MAV_PARAM_TYPE_UINT8,
               "integer_of takes either");

/* An integer of a MAV_PARAM_TYPE that begins with these bytes, as bits of an
 * IEEE 754 number; NOT_A_NUMBER for the other types. */
static uint32_t integer_of(uint32_t bits, uint8_t type)
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

/* What a PARAM_SET carries.  Some hosts cast every value to a float; others put
 * an integer's own bytes there and say so by its type.  The two cannot be
 * confused: an integer below 2^23, more than any parameter needs, has the bytes
 * of a float that is subnormal or none, and no integer's float is either.  Zero
 * has the same bytes in both: its type decides.  Bytes of neither are not a
 * number: as a float they would count as zero. */
typedef struct {
    uint32_t number; /* bits of an IEEE 754 number */
    bool whole;      /* it came as an integer's own bytes */
} carried_t;

static carried_t carried_by(uint32_t bits, uint8_t type)
{
    const uint32_t exponent = bits >> 23 & 0xFF;
    const bool zero = bits << 1 == 0;
    const bool is_float = zero || (exponent != 0 && exponent != 0xFF);
    const uint32_t integer = integer_of(bits, type);
    return (carried_t){is_float ? bits : integer,
                       integer != NOT_A_NUMBER && (zero || !is_float)};
}

/* Answers a list or a read about these parameters, a bit each. */
static void answer(link_t *link, const received_t *message, uint32_t which)
{
    const bool typed = message->id == MAVLINK_MSG_ID_PARAM_EXT_REQUEST_LIST ||
                       message->id == MAVLINK_MSG_ID_PARAM_EXT_REQUEST_READ;
    const uint32_t whole =
        message->system == MAVSDK_SYSTEM ? which & ~link->parameters.floats : 0;
    if (typed) {
        link_values_due(link, VALUE_TYPED, which);
        return;
    }
    link_values_due(link, VALUE_WHOLE, whole);
    link_values_due(link, VALUE_FLOAT, which & ~whole);
}

void link_on_parameter_list(dock_t *dock, const received_t *message,
                            uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_request_list_t request;
    message_read(&request, sizeof request, message);
    if (link_is_for_us(&dock->link, request.target_system,
                       request.target_component))
        answer(&dock->link, message, LINK_ALL_VALUES);
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
        answer(&dock->link, message, UINT32_C(1) << index);
}

/* Index of a parameter that this dock is to set; -1 for none. */
static int find_to_set(link_t *link, uint8_t system, uint8_t component,
                       const char name[16])
{
    if (!link_is_for_this(link, system, component))
        return -1;
    const int index = link_find_parameter(link, name);
    if (index < 0)
        link_count_fault(link);
    return index;
}

static void put_bit(uint32_t *bits, uint32_t bit, bool set)
{
    *bits = set ? *bits | bit : *bits & ~bit;
}

void link_on_parameter_set(dock_t *dock, const received_t *message,
                           uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_set_t request;
    message_read(&request, sizeof request, message);
    const int index = find_to_set(&dock->link, request.target_system,
                                  request.target_component, request.param_id);
    if (index < 0)
        return;
    uint32_t bits;
    memcpy(&bits, &request.param_value, sizeof bits);
    const carried_t carried = carried_by(bits, request.param_type);
    const uint32_t bit = UINT32_C(1) << index;
    link_set_parameter(dock, index, carried.number);
    if (message->system == MAVSDK_SYSTEM)
        put_bit(&dock->link.parameters.floats, bit, !carried.whole);
    /* The value as it is now, refused or not, in the way that it came. */
    link_values_due(&dock->link, carried.whole ? VALUE_WHOLE : VALUE_FLOAT,
                    bit);
}

void link_on_typed_set(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    (void)now_ms;
    mavlink_param_ext_set_t request;
    message_read(&request, sizeof request, message);
    const int index = find_to_set(&dock->link, request.target_system,
                                  request.target_component, request.param_id);
    if (index < 0)
        return;
    uint32_t bits;
    memcpy(&bits, request.param_value, sizeof bits);
    if (request.param_type != MAV_PARAM_EXT_TYPE_REAL32)
        bits = integer_of(bits, request.param_type);
    const uint32_t bit = UINT32_C(1) << index;
    put_bit(&dock->link.parameters.refused, bit,
            !link_set_parameter(dock, index, bits));
    link_values_due(&dock->link, VALUE_TYPED_ACK, bit);
}
