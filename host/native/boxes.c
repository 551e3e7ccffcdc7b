#include "boxes.h"

#include "internal/vectors.h"

#include <stddef.h>
#include <string.h>

/* So many bytes add up in 16 bits, which vector instructions add most of at
 * once. */
#define ROWS 257

/* Cells whose quotients are worked out together. */
#define CELLS 32

/* Numbers that are added up together, as many as fit a vector: the channels of
 * a pixel, and BOXES_SPARE behind them, whose sums nobody needs. */
#define LANES 8
_Static_assert(LANES == 3 + BOXES_SPARE, "what is read lies in the room");

static boxes_part_t part_of(int32_t cell, int32_t size, int32_t cells)
{
    const int32_t first = cell * size / cells;
    const int32_t end = (cell + 1) * size / cells;
    return (boxes_part_t){first, end > first ? end : first + 1};
}

/* Adds the pixels of some rows, ROWS at most, to the sums of the cells that
 * they are in.  room: for one row of numbers and BOXES_SPARE more. */
WIDE_VECTORS static void add_rows(const uint8_t *rows, int32_t count,
                                  int32_t width, const boxes_part_t *columns,
                                  int32_t across, uint16_t *restrict room,
                                  uint32_t *restrict sums)
{
    const size_t numbers = 3 * (size_t)width;
    memset(room, 0, (numbers + BOXES_SPARE) * sizeof *room);
    int32_t y = 0;
    /* Four at once, for the sums need be fetched and put back but once. */
    for (; y + 4 <= count; y += 4) {
        const uint8_t *restrict row = rows + (size_t)y * numbers;
        for (size_t k = 0; k < numbers; k++)
            room[k] = (uint16_t)(room[k] + row[k] + row[k + numbers] +
                                 row[k + 2 * numbers] + row[k + 3 * numbers]);
    }
    for (; y < count; y++) {
        const uint8_t *restrict row = rows + (size_t)y * numbers;
        for (size_t k = 0; k < numbers; k++)
            room[k] = (uint16_t)(room[k] + row[k]);
    }
    for (int32_t j = 0; j < across; j++, sums += 3) {
        uint32_t cell[LANES] = {0};
#pragma GCC unroll 4
        for (int32_t x = columns[j].first; x < columns[j].end; x++) {
            /* Unrolled, it would not be made of vector instructions. */
#pragma GCC unroll 1
            for (int32_t c = 0; c < LANES; c++)
                cell[c] += room[3 * x + c];
        }
        for (int32_t c = 0; c < 3; c++)
            sums[c] += cell[c];
    }
}

/* Means of some cells, CELLS at most, from the sums of their pixels; full:
 * three numbers a cell, what a sum would be at full scale. */
WIDE_VECTORS static void divide(const uint32_t *restrict sums,
                                const double *restrict full, int32_t cells,
                                uint8_t *restrict means)
{
    /* Exact: no quotient of integers below 2^53 rounds up to a whole number. */
    for (int32_t k = 0; k < 3 * cells; k++)
        means[k] =
            (uint8_t)(int32_t)((510.0 * sums[k] + full[k]) / (2.0 * full[k]));
}

void boxes_mean(const uint8_t *pixels, int32_t height, int32_t width,
                int32_t down, int32_t across, const uint8_t scale[3],
                boxes_part_t *columns, uint16_t *room, uint32_t *sums,
                uint8_t *means)
{
    const size_t numbers = 3 * (size_t)across;
    for (int32_t j = 0; j < across; j++)
        columns[j] = part_of(j, width, across);
    for (int32_t i = 0; i < down; i++, means += numbers) {
        const boxes_part_t rows = part_of(i, height, down);
        memset(sums, 0, numbers * sizeof *sums);
        for (int32_t y = rows.first; y < rows.end; y += ROWS) {
            const int32_t left = rows.end - y;
            add_rows(pixels + (size_t)y * 3 * (size_t)width,
                     left < ROWS ? left : ROWS, width, columns, across, room,
                     sums);
        }
        for (int32_t j = 0; j < across; j += CELLS) {
            const int32_t cells = across - j < CELLS ? across - j : CELLS;
            double full[3 * CELLS] = {0};
            for (int32_t k = 0; k < cells; k++) {
                const boxes_part_t wide = columns[j + k];
                const double count = (double)(rows.end - rows.first) *
                                     (double)(wide.end - wide.first);
                for (int32_t c = 0; c < 3; c++)
                    full[3 * k + c] = scale[c] * count;
            }
            divide(sums + 3 * j, full, cells, means + 3 * j);
        }
    }
}
