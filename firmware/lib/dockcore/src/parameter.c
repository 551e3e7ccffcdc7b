#include "parameter.h"

#include <string.h>

#include "real32.h"

int32_t parameter_get(const parameter_t *parameter,
                      const dock_settings_t *settings)
{
    const uint8_t *at = (const uint8_t *)settings + parameter->offset;
    uint32_t value = 0;
    for (uint8_t i = 0; i < parameter->size; i++)
        value |= (uint32_t)at[i] << 8 * i;
    const uint32_t sign = UINT32_C(1) << (8 * parameter->size - 1);
    if (parameter->minimum < 0)
        value = (value ^ sign) - sign;
    return (int32_t)value;
}

bool parameter_set(const parameter_t *parameter, dock_settings_t *settings,
                   int32_t stored)
{
    if (stored < parameter->minimum || stored > parameter->maximum)
        return false;
    uint8_t *at = (uint8_t *)settings + parameter->offset;
    for (uint8_t i = 0; i < parameter->size; i++)
        at[i] = (uint8_t)((uint32_t)stored >> 8 * i);
    return true;
}

uint32_t parameter_to_real32(const parameter_t *parameter, int32_t stored)
{
    return real32_from_fixed((int64_t)stored * parameter->numerator,
                             parameter->shift);
}

/* Bits more than are kept, so that the division rounds and not what is before
 * it: the longest range, 921,600 with no shift, has room for 33. */
#define GUARD_BITS 20

bool parameter_from_real32(const parameter_t *parameter, uint32_t bits,
                           int32_t *stored)
{
    int64_t fixed;
    const uint8_t shift = (uint8_t)(parameter->shift + GUARD_BITS);
    if (!real32_to_fixed(bits, shift, &fixed))
        return false;
    const int64_t unit = (int64_t)parameter->numerator << GUARD_BITS;
    const int64_t rounded = (fixed + (fixed < 0 ? -unit : unit) / 2) / unit;
    if (rounded < INT32_MIN || rounded > INT32_MAX)
        return false;
    *stored = (int32_t)rounded;
    return true;
}
