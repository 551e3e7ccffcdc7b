/* The working image smoothed, row by row. */
#ifndef SMOOTH_H
#define SMOOTH_H

#include <stdint.h>

#include "working_image.h"

/* Takes one row of packed pixels (pixel.h); `context` is the caller's. */
typedef void row_taker_t(void *context, const uint32_t row[WORKING_WIDTH]);

/* Gives `take` all rows of an image, one after the other from the top; as often
 * as it is called. */
typedef void row_source_t(void *image, row_taker_t *take, void *context);

/* The working image of a frame, smoothed: how it is read, and the rows that it
 * takes at a time. */
typedef struct {
    working_image_t working;
    uint32_t above[WORKING_WIDTH], row[2][WORKING_WIDTH];
} smoothed_t;

/* Prepares to read a valid frame, which must stay in place. */
void smoothed_open(smoothed_t *smoothed, const frame_t *frame);

/* The row_source_t of a smoothed_t: the working image after a 3 x 3 binomial
 * blur, edge pixels repeated outwards, halves up:
 * cv2.GaussianBlur(image, (3, 3), 0, borderType=BORDER_REPLICATE). */
void smoothed_rows(void *smoothed, row_taker_t *take, void *context);

#endif
