#include "boxes.h"

#include "internal/vectors.h"

#include <stddef.h>
#include <string.h>

/* So many bytes add up in 16 bits, which vector instructions add most of at
 * once. */
#define ROWS 257

/* Of so many steps from 0 on, those that are a cell's. */
typedef struct {
    int32_t first, end;
} part_t;

static part_t part_of(int32_t cell, int32_t size, int32_t cells)
{
    const int32_t first = (int32_t)((int64_t)cell * size / cells);
    const int32_t next = (int32_t)(((int64_t)cell + 1) * size / cells);
    return (part_t){first, next > first ? next : first + 1};
}

/* Adds the pixels of some rows, ROWS at most, to the sums of the cells that
 * they are in.  room: for one row of numbers. */
WIDE_VECTORS static void add_rows(const uint8_t *rows, int32_t count,
                                  int32_t width, int32_t across,
                                  uint16_t *restrict room,
                                  uint32_t *restrict sums)
{
    const size_t numbers = 3 * (size_t)width;
    memset(room, 0, numbers * sizeof *room);
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
        const part_t columns = part_of(j, width, across);
        uint32_t first = 0, second = 0, third = 0;
#pragma GCC unroll 4
        for (int32_t x = columns.first; x < columns.end; x++) {
            first += room[3 * x];
            second += room[3 * x + 1];
            third += room[3 * x + 2];
        }
        sums[0] += first;
        sums[1] += second;
        sums[2] += third;
    }
}

void boxes_mean(const uint8_t *pixels, int32_t height, int32_t width,
                int32_t down, int32_t across, const uint8_t scale[3],
                uint16_t *room, uint32_t *sums, uint8_t *means)
{
    const size_t numbers = 3 * (size_t)across;
    for (int32_t i = 0; i < down; i++) {
        const part_t rows = part_of(i, height, down);
        memset(sums, 0, numbers * sizeof *sums);
        for (int32_t y = rows.first; y < rows.end; y += ROWS) {
            const int32_t left = rows.end - y;
            add_rows(pixels + (size_t)y * 3 * (size_t)width,
                     left < ROWS ? left : ROWS, width, across, room, sums);
        }
        for (int32_t j = 0; j < across; j++) {
            const part_t columns = part_of(j, width, across);
            const double count = (double)(rows.end - rows.first) *
                                 (double)(columns.end - columns.first);
            for (int c = 0; c < 3; c++) {
                /* Exact: no quotient of integers below 2^53 rounds up to a
                 * whole number. */
                const double full = scale[c] * count;
                means[3 * j + c] =
                    (uint8_t)((510.0 * sums[3 * j + c] + full) / (2.0 * full));
            }
        }
        means += numbers;
    }
}
