#include "hsv.h"

_Static_assert(METHOD_HUE_RANGE == 6 * 256, "a sextant is a byte of hue");

rgb_t rgb_from_hsv(uint32_t hue, uint32_t saturation, uint32_t value)
{
    const uint32_t low = value - (value * saturation + 127) / 255;
    const uint32_t chroma = value - low;
    const uint32_t step = hue & 255;
    const uint8_t l = (uint8_t)low, v = (uint8_t)value;
    const uint8_t rising = (uint8_t)(low + ((chroma * step + 128) >> 8));
    const uint8_t falling =
        (uint8_t)(low + ((chroma * (256 - step) + 128) >> 8));
    switch (hue >> 8) {
    case 0:
        return (rgb_t){v, rising, l};
    case 1:
        return (rgb_t){falling, v, l};
    case 2:
        return (rgb_t){l, v, rising};
    case 3:
        return (rgb_t){l, falling, v};
    case 4:
        return (rgb_t){rising, l, v};
    default:
        return (rgb_t){v, l, falling};
    }
}
