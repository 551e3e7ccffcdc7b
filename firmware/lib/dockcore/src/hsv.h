/* RGB and HSV on the hexcone, integer.  Hue 0..METHOD_HUE_RANGE-1 (red 0, green
 * 512, blue 1024), saturation and value 0..255. */
#ifndef HSV_H
#define HSV_H

#include <stdint.h>

#include "method.h"

/* Words, though the values are small: nothing is cut off on the way. */
typedef struct {
    uint32_t hue;
    uint32_t saturation;
    uint32_t value;
    uint32_t chroma; /* value minus the least channel */
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
    /* A tree rather than minimum and maximum: each sextant compares twice or
     * three times and knows all the rest. */
    uint32_t value, least;
    uint32_t distance; /* along the hexagon from red, less `turned` chromas */
    uint32_t turned;
    if (red >= green) {
        if (green >= blue) {
            value = red, least = blue, distance = green - blue, turned = 0;
        } else if (red >= blue) {
            value = red, least = green, distance = green - blue, turned = 0;
        } else {
            value = blue, least = green, distance = red - green, turned = 4;
        }
    } else {
        if (blue > green) {
            value = blue, least = red, distance = red - green, turned = 4;
        } else if (blue > red) {
            value = green, least = red, distance = blue - red, turned = 2;
        } else {
            value = green, least = blue, distance = blue - red, turned = 2;
        }
    }
    const uint32_t chroma = value - least;
    distance += turned * chroma;
    /* Arithmetic shift: rounds halves up below red too. */
    int32_t hue = ((int32_t)(distance * scale.division[chroma]) +
                   (INT32_C(1) << (scale.shift - 1))) >>
                  scale.shift;
    if (hue < 0)
        hue += scale.range;
    const uint32_t saturation = (chroma * METHOD_SATURATION_DIVISION[value] +
                                 (1u << (METHOD_OPENCV_SHIFT - 1))) >>
                                METHOD_OPENCV_SHIFT;
    return (hsv_t){(uint32_t)hue, saturation, value, chroma};
}

static inline hsv_t hsv_from_rgb(uint32_t red, uint32_t green, uint32_t blue)
{
    return hsv_on_scale(red, green, blue, HUE_SCALE);
}

/* The inverse.  A pure colour (saturation and value 255) goes to its hue and
 * back unchanged. */
rgb_t rgb_from_hsv(uint32_t hue, uint32_t saturation, uint32_t value);

#endif
