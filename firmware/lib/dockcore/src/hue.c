#include "hue.h"

static uint32_t magnitude(int32_t value)
{
    return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

uint32_t hue_distance(uint32_t a, uint32_t b)
{
    const uint32_t apart = a < b ? b - a : a - b;
    return apart <= METHOD_HUE_RANGE / 2 ? apart : METHOD_HUE_RANGE - apart;
}

bool hue_of_vector(hue_vector_t vector, uint16_t *hue)
{
    const uint32_t x = magnitude(vector.x), y = magnitude(vector.y);
    uint32_t near = x < y ? x : y, far = x < y ? y : x;
    if (far == 0)
        return false;
    while (far >= UINT32_C(1) << 21) { /* near * ATAN_STEPS fits in 32 bits */
        near >>= 1;
        far >>= 1;
    }
    uint32_t angle =
        METHOD_ARCTANGENT[(near * METHOD_ATAN_STEPS + far / 2) / far];
    if (y > x)
        angle = METHOD_HUE_RANGE / 4 - angle;
    if (vector.x < 0)
        angle = METHOD_HUE_RANGE / 2 - angle;
    if (vector.y < 0)
        angle = METHOD_HUE_RANGE - angle;
    *hue = (uint16_t)(angle == METHOD_HUE_RANGE ? 0 : angle);
    return true;
}
