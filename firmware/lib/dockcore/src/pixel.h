/* One pixel of the working image in a word, the channels ten bits apart: room
 * for sums of four 8-bit values, so that one addition adds all three. */
#ifndef PIXEL_H
#define PIXEL_H

#include <stdint.h>

#define PIXEL_RED_SHIFT 20
#define PIXEL_GREEN_SHIFT 10

static inline uint32_t pixel_pack(uint32_t red, uint32_t green, uint32_t blue)
{
    return red << PIXEL_RED_SHIFT | green << PIXEL_GREEN_SHIFT | blue;
}

static inline uint32_t pixel_red(uint32_t pixel)
{
    return pixel >> PIXEL_RED_SHIFT & 0xFF;
}

static inline uint32_t pixel_green(uint32_t pixel)
{
    return pixel >> PIXEL_GREEN_SHIFT & 0xFF;
}

static inline uint32_t pixel_blue(uint32_t pixel)
{
    return pixel & 0xFF;
}

#endif
