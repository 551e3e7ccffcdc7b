#include "marker.h"

/* A power of two, so that the compiler shifts instead of dividing. */
_Static_assert((METHOD_MARKER_NODE_STEP & (METHOD_MARKER_NODE_STEP - 1)) == 0,
               "hue steps between two nodes");

uint16_t marker_hue(const background_t *background, uint8_t mapping,
                    uint16_t fallback_hue)
{
    if (!background->meaningful)
        return fallback_hue;
    const uint32_t node = background->hue / METHOD_MARKER_NODE_STEP;
    const uint32_t beyond = background->hue % METHOD_MARKER_NODE_STEP;
    const uint16_t *nodes =
        &METHOD_MARKER_HUE[mapping * (METHOD_MARKER_NODES + 1) + node];
    const uint32_t hue = (nodes[0] * (METHOD_MARKER_NODE_STEP - beyond) +
                          nodes[1] * beyond + METHOD_MARKER_NODE_STEP / 2) /
                         METHOD_MARKER_NODE_STEP;
    return (uint16_t)(hue < METHOD_HUE_RANGE ? hue : hue - METHOD_HUE_RANGE);
}
