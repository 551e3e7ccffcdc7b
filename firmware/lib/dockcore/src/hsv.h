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

/* How hue is counted: steps a turn, and the table that divides by chroma. */
typedef struct {
    uint16_t range;
    uint8_t shift; /* fixed point of the table */
    const uint32_t *division;
} hue_scale_t;

#define HUE_SCALE \
    ((hue_scale_t){METHOD_HUE_RANGE, METHOD_HUE_SHIFT, METHOD_HUE_DIVISION})
/* With these the result is that of OpenCV's 8-bit COLOR_RGB2HSV and
 * COLOR_RGB2HSV_FULL on every colour. */
#define HUE_SCALE_180 \
    ((hue_scale_t){180, METHOD_OPENCV_SHIFT, METHOD_HUE_DIVISION_180})
#define HUE_SCALE_256 \
    ((hue_scale_t){256, METHOD_OPENCV_SHIFT, METHOD_HUE_DIVISION_256})

static inline hsv_t hsv_on_scale(uint32_t red, uint32_t green, uint32_t blue,
                                 hue_scale_t scale)
{
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
    /* Arithmetic shift: rounds halves up below red too. */
    int32_t hue = ((int32_t)(distance * scale.division[chroma]) +
                   (INT32_C(1) << (scale.shift - 1))) >>
                  scale.shift;
    if (hue < 0)
        hue += scale.range;
    hsv_t hsv;
    hsv.hue = (uint16_t)hue;
    hsv.saturation = (uint8_t)((chroma * METHOD_SATURATION_DIVISION[value] +
                                (1u << (METHOD_OPENCV_SHIFT - 1))) >>
                               METHOD_OPENCV_SHIFT);
    hsv.value = (uint8_t)value;
    hsv.chroma = (uint8_t)chroma;
    return hsv;
}

static inline hsv_t hsv_from_rgb(uint32_t red, uint32_t green, uint32_t blue)
{
    return hsv_on_scale(red, green, blue, HUE_SCALE);
}

/* The inverse.  A pure colour (saturation and value 255) goes to its hue and
 * back unchanged. */
rgb_t rgb_from_hsv(uint32_t hue, uint32_t saturation, uint32_t value);

#endif
