/* The working image as a whole, before and after it is smoothed: dockcore reads
 * it row by row, the tests and the Python binding look at every pixel. */
#ifndef WHOLE_IMAGE_H
#define WHOLE_IMAGE_H

#include <stdint.h>

#include "background.h"
#include "frame.h"

/* Packed pixels (pixel.h), rows from the top. */
typedef struct {
    uint32_t pixel[WORKING_PIXELS];
} whole_image_t;

/* The working image of a valid frame, not smoothed. */
void whole_image_working(whole_image_t *image, const frame_t *frame);

/* The same, smoothed. */
void whole_image_smoothed(whole_image_t *image, const frame_t *frame);

/* The background of a smoothed image, as background_from_rows finds it. */
void whole_image_background(background_t *background, whole_image_t *image,
                            uint8_t likely_bin);

#endif
