/* RGB and HSV on the hexcone, integer.  Hue 0..METHOD_HUE_RANGE-1 (red 0, green
 * 512, blue 1024), saturation and value 0..255. */
#ifndef HSV_H
#define HSV_H

#include <stdint.h>

#include "method.h"

typedef struct {
    uint16_t hue;
    uint8_t saturation;
    uint8_t value;
    uint8_t chroma; /* value minus the least channel */
} hsv_t;

typedef struct {
    uint8_t red, green, blue;
} rgb_t;

/* `division` and `range` choose the hue's unit: with METHOD_HUE_DIVISION_180,
 * 180 and METHOD_HUE_DIVISION_256, 256 the result is that of OpenCV's 8-bit
 * COLOR_RGB2HSV and COLOR_RGB2HSV_FULL on every colour. */
static inline hsv_t hsv_with_range(uint32_t red, uint32_t green, uint32_t blue,
                                   const uint32_t *division, uint32_t range)
{
    const int32_t half = 1 << (METHOD_HSV_SHIFT - 1);
    const uint32_t most = red > green ? red : green;
    const uint32_t least = red > green ? green : red;
    const uint32_t value = most > blue ? most : blue;
    const uint32_t chroma = value - (least < blue ? least : blue);
    uint32_t distance; /* along the hexagon from red, in units of chroma */
    if (value == red)
        distance = green - blue;
    else if (value == green)
        distance = blue - red + 2 * chroma;
    else
        distance = red - green + 4 * chroma;
    int32_t hue = ((int32_t)(distance * division[chroma]) + half) >>
                  METHOD_HSV_SHIFT; /* arithmetic shift: rounds below red too */
    if (hue < 0)
        hue += (int32_t)range;
    hsv_t hsv;
    hsv.hue = (uint16_t)hue;
    hsv.saturation = (uint8_t)((chroma * METHOD_SATURATION_DIVISION[value] +
                                (uint32_t)half) >>
                               METHOD_HSV_SHIFT);
    hsv.value = (uint8_t)value;
    hsv.chroma = (uint8_t)chroma;
    return hsv;
}

static inline hsv_t hsv_from_rgb(uint32_t red, uint32_t green, uint32_t blue)
{
    return hsv_with_range(red, green, blue, METHOD_HUE_DIVISION,
                          METHOD_HUE_RANGE);
}

/* The inverse.  A pure colour (saturation and value 255) goes to its hue and
 * back unchanged. */
rgb_t rgb_from_hsv(uint32_t hue, uint32_t saturation, uint32_t value);

#endif
