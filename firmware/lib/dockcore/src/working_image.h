/* The 80 x 60 image that every decision is made on, whatever the camera. */
#ifndef WORKING_IMAGE_H
#define WORKING_IMAGE_H

#include <stdint.h>

#include "frame.h"
#include "method.h"

#define WORKING_PIXELS (METHOD_WORKING_WIDTH * METHOD_WORKING_HEIGHT)

/* One pixel a word, the channels ten bits apart: room for sums of four 8-bit
 * values, so that one addition adds all three channels. */
typedef struct {
    uint32_t pixel[WORKING_PIXELS];
} working_image_t;

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

/* Box average of a valid frame.  Cell i of n covers the source pixels from
 * floor(i * size / n) up to, not including, floor((i + 1) * size / n), at least
 * one: an exact share where the size is a multiple.  A channel is the mean of
 * its pixels on the scale 0..255, rounded once, halves up; RGB565 is not
 * widened to 8 bits before the mean. */
void working_image_from_frame(working_image_t *image, const frame_t *frame);

/* 3 x 3 binomial blur in place, edge pixels repeated outwards, halves up:
 * cv2.GaussianBlur(image, (3, 3), 0, borderType=BORDER_REPLICATE). */
void working_image_smooth(working_image_t *image);

#endif
