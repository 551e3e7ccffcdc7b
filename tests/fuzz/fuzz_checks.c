/* What a message must have done to the dock. */
#include <math.h>
#include <string.h>

#include <chromadock/mavlink.h>

#include "fuzz.h"

/* The receiver apart: it may hold bytes, and counts what it refused. */
void must_be_as_before(void)
{
    before.link.receiver = dock.link.receiver;
    MUST(memcmp(&before, &dock, sizeof dock) == 0);
}

/* The number that a PARAM_SET means: a float, or the bytes of an integer where
 * its type says so and no float has them. */
static double meant(const mavlink_param_set_t *set)
{
    const float value = set->param_value;
    int8_t of8;
    int16_t of16;
    int32_t of32;
    memcpy(&of8, &value, sizeof of8);
    memcpy(&of16, &value, sizeof of16);
    memcpy(&of32, &value, sizeof of32);
    if (isnormal(value) || value == 0)
        return value;
    switch (set->param_type) {
    case MAV_PARAM_TYPE_UINT8:
        return (uint8_t)of8;
    case MAV_PARAM_TYPE_INT8:
        return of8;
    case MAV_PARAM_TYPE_UINT16:
        return (uint16_t)of16;
    case MAV_PARAM_TYPE_INT16:
        return of16;
    case MAV_PARAM_TYPE_UINT32:
        return (uint32_t)of32;
    case MAV_PARAM_TYPE_INT32:
        return of32;
    default:
        return NAN;
    }
}

/* What PARAM_SET must have done, by this computer's floating point. */
void check_parameter_set(const uint8_t *payload)
{
    mavlink_param_set_t set;
    memcpy(&set, payload, sizeof set);
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t was = parameter_get(p, &before.settings);
        const int32_t is = parameter_get(p, &dock.settings);
        const double scaled =
            meant(&set) / p->numerator * (double)(UINT64_C(1) << p->shift);
        const double off = fabs(scaled - is);
        if (strncmp(p->name, set.param_id, sizeof set.param_id) != 0)
            MUST(is == was);
        else if (!(scaled > p->minimum - 0.501 && scaled < p->maximum + 0.501))
            MUST(is == was);
        else if (scaled > p->minimum - 0.499 && scaled < p->maximum + 0.499)
            MUST(off < 0.501);
    }
}

/* A command that is refused has done nothing but to be counted. */
void check_command(void)
{
    const link_acks_t *acks = &dock.link.acks;
    if (acks->count == before.link.acks.count)
        return;
    const uint8_t result = acks->waiting[acks->count - 1].result;
    if (result == MAV_RESULT_ACCEPTED || result == MAV_RESULT_IN_PROGRESS)
        return;
    before.link.acks = *acks;
    before.link.faults = dock.link.faults;
    must_be_as_before();
}
