/* The 80 x 60 image that every decision is made on, whatever the camera, read
 * from a frame row by row: it is nowhere stored as a whole. */
#ifndef WORKING_IMAGE_H
#define WORKING_IMAGE_H

#include <stdint.h>

#include "frame.h"
#include "method.h"

#define WORKING_WIDTH METHOD_WORKING_WIDTH
#define WORKING_HEIGHT METHOD_WORKING_HEIGHT
#define WORKING_PIXELS (WORKING_WIDTH * WORKING_HEIGHT)

/* How a frame is read. */
typedef struct {
    const frame_t *frame;
    bool is_qqvga; /* the camera's own: all else is not needed */
    uint16_t column[WORKING_WIDTH + 1]; /* first source pixel of each cell */
    uint16_t narrow, low;               /* pixels of the smallest cell */
    uint64_t green_scale[2][2]; /* of a mean, one row more, one column */
    uint64_t other_scale[2][2];
} working_image_t;

/* Prepares to read a valid frame, which must stay in place. */
void working_image_open(working_image_t *image, const frame_t *frame);

/* Row y, 0..WORKING_HEIGHT - 1, as packed pixels (pixel.h): a box average.
 * Cell i of n covers the source pixels from floor(i * size / n) up to, not
 * including, floor((i + 1) * size / n), at least one: an exact share where the
 * size is a multiple.  A channel is the mean of its pixels on the scale 0..255,
 * rounded once, halves up; RGB565 is not widened to 8 bits before the mean. */
void working_image_row(const working_image_t *image, uint32_t y,
                       uint32_t row[WORKING_WIDTH]);

#endif
