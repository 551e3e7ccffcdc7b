/* RGB and HSV on the hexcone, integer.  Hue 0..METHOD_HUE_RANGE-1 (red 0, green
 * 512, blue 1024), saturation and value 0..255. */
#ifndef HSV_H
#define HSV_H

#include <stdbool.h>
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
    /* To the bit, a distance of n chromas more is n / 6 of the range more. */
    bool exact;
} hue_scale_t;

#define HUE_SCALE                                                           \
    ((hue_scale_t){METHOD_HUE_RANGE, METHOD_HUE_SHIFT, METHOD_HUE_DIVISION, \
                   true})
/* With these the result is that of OpenCV's 8-bit COLOR_RGB2HSV and
 * COLOR_RGB2HSV_FULL on every colour. */
#define HUE_SCALE_180 \
    ((hue_scale_t){180, METHOD_OPENCV_SHIFT, METHOD_HUE_DIVISION_180, false})
#define HUE_SCALE_256 \
    ((hue_scale_t){256, METHOD_OPENCV_SHIFT, METHOD_HUE_DIVISION_256, false})

/* What is added to distance * division where the distance is counted from the
 * corner of the hexagon `chromas` behind red: the hue there, and a half. */
static inline uint32_t hue_corner(hue_scale_t scale, uint32_t chromas)
{
    const uint32_t half = UINT32_C(1) << (scale.shift - 1);
    return scale.exact ? (chromas * scale.range / 6 << scale.shift) + half
                       : half;
}

static inline hsv_t hsv_on_scale(uint32_t red, uint32_t green, uint32_t blue,
                                 hue_scale_t scale)
{
    const uint32_t at_red = hue_corner(scale, 0);
    const uint32_t at_green = hue_corner(scale, 2);
    const uint32_t at_blue = hue_corner(scale, 4);
    const uint32_t at_red_again = hue_corner(scale, 6);
    /* A tree rather than minimum and maximum: each sextant compares twice or
     * three times and knows all the rest. */
    uint32_t value, least;
    uint32_t distance; /* along the hexagon, from the corner */
    uint32_t corner;
    if (red >= green) {
        if (green >= blue) {
            value = red, least = blue;
            distance = green - blue, corner = at_red;
        } else if (red >= blue) {
            value = red, least = green;
            distance = green - blue, corner = at_red_again;
        } else {
            value = blue, least = green;
            distance = red - green, corner = at_blue;
        }
    } else {
        if (blue > green) {
            value = blue, least = red;
            distance = red - green, corner = at_blue;
        } else if (blue > red) {
            value = green, least = red;
            distance = blue - red, corner = at_green;
        } else {
            value = green, least = blue;
            distance = blue - red, corner = at_green;
        }
    }
    const uint32_t chroma = value - least;
    if (!scale.exact)
        distance += (value == red ? 0u : value == green ? 2u : 4u) * chroma;
    /* Arithmetic shift: rounds halves up below red too. */
    int32_t hue =
        (int32_t)(distance * scale.division[chroma] + corner) >> scale.shift;
    if (!scale.exact && hue < 0)
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
