/* Sums of a picture's pixels over a grid of cells: what any frame's working
 * image is made of.  Nothing here allocates memory or keeps anything. */
#ifndef BOXES_H
#define BOXES_H

#include <stdint.h>

/* Adds up the pixels of each cell.
 *
 * pixels: height x width x 3 bytes, row by row without gaps.
 * Cell i of n down (or across) covers the pixels from floor(i * size / n) up
 * to, not including, floor((i + 1) * size / n), at least one: where the grid is
 * finer than the picture, a pixel counts in several cells.
 * room: for 3 x width numbers.
 * sums: receives down x across x 3 numbers; they do not overflow while a cell
 * has no more than 16,843,009 pixels. */
void boxes_sum(const uint8_t *pixels, int32_t height, int32_t width,
               int32_t down, int32_t across, uint16_t *room, uint32_t *sums);

#endif
