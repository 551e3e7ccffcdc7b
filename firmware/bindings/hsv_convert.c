#include "hsv_convert.h"

#include "hsv.h"

void hsv_convert(const uint8_t *rgb, size_t n, uint32_t range, uint16_t *hue,
                 uint8_t *saturation, uint8_t *value)
{
    const hue_scale_t scale = range == 180   ? HUE_SCALE_180
                              : range == 256 ? HUE_SCALE_256
                                             : HUE_SCALE;
    for (size_t i = 0; i < n; i++, rgb += 3) {
        const hsv_t hsv = hsv_on_scale(rgb[0], rgb[1], rgb[2], scale);
        hue[i] = hsv.hue;
        saturation[i] = hsv.saturation;
        value[i] = hsv.value;
    }
}
