#include "marker.h"

uint16_t marker_hue(const background_t *background, uint8_t mapping,
                    uint16_t fallback_hue)
{
    if (!background->meaningful)
        return fallback_hue;
    const uint32_t hue = background->hue + METHOD_MAPPING_TURN[mapping];
    return (uint16_t)(hue < METHOD_HUE_RANGE ? hue : hue - METHOD_HUE_RANGE);
}
