/* dockcore's colour conversion over an array: for the tests that go through all
 * 2^24 colours. */
#ifndef HSV_CONVERT_H
#define HSV_CONVERT_H

#include <stddef.h>
#include <stdint.h>

/* rgb: 3 n bytes; range: METHOD_HUE_RANGE, 180 or 256; n values out of each. */
void hsv_convert(const uint8_t *rgb, size_t n, uint32_t range, uint16_t *hue,
                 uint8_t *saturation, uint8_t *value);

#endif
