#include "hsv_convert.h"

#include "hsv.h"

void hsv_convert(const uint8_t *rgb, size_t n, uint32_t range, uint16_t *hue,
                 uint8_t *saturation, uint8_t *value)
{
    const uint32_t *division = range == 180   ? METHOD_HUE_DIVISION_180
                               : range == 256 ? METHOD_HUE_DIVISION_256
                                              : METHOD_HUE_DIVISION;
    for (size_t i = 0; i < n; i++, rgb += 3) {
        const hsv_t hsv =
            hsv_with_range(rgb[0], rgb[1], rgb[2], division, range);
        hue[i] = hsv.hue;
        saturation[i] = hsv.saturation;
        value[i] = hsv.value;
    }
}
