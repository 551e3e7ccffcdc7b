/* The dock camera's own frames, 160 x 120 RGB565, averaged in a third of the
 * instructions that a frame of any size takes; the same bits. */
#ifndef QQVGA_H
#define QQVGA_H

#include <stdbool.h>
#include <stdint.h>

#include "frame.h"
#include "method.h"

/* True where every cell is 2 x 2 RGB565 pixels at a word's address. */
bool qqvga_is_rgb565(const frame_t *frame);

/* Row y of the working image, as working_image_row has it. */
void qqvga_row(const frame_t *frame, uint32_t y,
               uint32_t row[METHOD_WORKING_WIDTH]);

#endif
