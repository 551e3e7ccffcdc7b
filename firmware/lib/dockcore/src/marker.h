/* From the water's colour to the colour that stands out from it. */
#ifndef MARKER_H
#define MARKER_H

#include "background.h"

/* Hue of the marker, a pure colour: what `mapping` (METHOD_MAPPING_...) has for
 * the background's, or `fallback_hue` where the background's means nothing. */
uint16_t marker_hue(const background_t *background, uint8_t mapping,
                    uint16_t fallback_hue);

#endif
