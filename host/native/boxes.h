/* Means of a picture's pixels over a grid of cells: what any frame's working
 * image is made of.  Nothing here allocates memory or keeps anything. */
#ifndef BOXES_H
#define BOXES_H

#include <stdint.h>

/* Numbers behind a row's own that are read with its last pixel. */
#define BOXES_SPARE 5

/* Of a frame's columns, or of its rows, those that a cell covers. */
typedef struct {
    int32_t first, end;
} boxes_part_t;

/* Means of the pixels of each cell, 0 to 255, rounded once, halves up.
 *
 * pixels: height x width x 3 bytes, row by row without gaps.
 * Cell i of n down (or across) covers the pixels from floor(i * size / n) up
 * to, not including, floor((i + 1) * size / n), at least one: where the grid is
 * finer than the picture, a pixel counts in several cells.  A cell has
 * 16,843,009 pixels at most.
 * scale: full scale of each channel, which becomes 255.
 * columns: room for one part for each cell across.
 * room: for 3 x width numbers and BOXES_SPARE more.
 * sums: room for 3 x across numbers.
 * means: receives down x across x 3 numbers. */
void boxes_mean(const uint8_t *pixels, int32_t height, int32_t width,
                int32_t down, int32_t across, const uint8_t scale[3],
                boxes_part_t *columns, uint16_t *room, uint32_t *sums,
                uint8_t *means);

#endif
