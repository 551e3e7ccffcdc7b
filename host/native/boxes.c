#include "boxes.h"

#include "internal/vectors.h"

#include <stddef.h>
#include <string.h>

/* So many bytes add up in 16 bits, which vector instructions add most of at
 * once. */
#define ROWS 257

/* Cells whose quotients are worked out together. */
#define CELLS 32

/* Of so many steps from 0 on, those that are a cell's. */
typedef struct {
    int32_t first, end;
} part_t;

/* Where the next cell begins: at `next`, and `over` parts of a step more, of
 * which there are as many as cells.  Without a division for each cell. */
typedef struct {
    int32_t next, over;
    int32_t whole, rest, cells;
} parts_t;

static parts_t parts_of(int32_t size, int32_t cells)
{
    return (parts_t){0, 0, size / cells, size % cells, cells};
}

static part_t next_part(parts_t *parts)
{
    const int32_t first = parts->next;
    parts->next += parts->whole;
    parts->over += parts->rest;
    if (parts->over >= parts->cells) {
        parts->over -= parts->cells;
        parts->next++;
    }
    return (part_t){first, parts->next > first ? parts->next : first + 1};
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
    parts_t parts = parts_of(width, across);
    for (int32_t j = 0; j < across; j++, sums += 3) {
        const part_t columns = next_part(&parts);
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
                uint16_t *room, uint32_t *sums, uint8_t *means)
{
    const size_t numbers = 3 * (size_t)across;
    parts_t all_rows = parts_of(height, down);
    for (int32_t i = 0; i < down; i++) {
        const part_t rows = next_part(&all_rows);
        memset(sums, 0, numbers * sizeof *sums);
        for (int32_t y = rows.first; y < rows.end; y += ROWS) {
            const int32_t left = rows.end - y;
            add_rows(pixels + (size_t)y * 3 * (size_t)width,
                     left < ROWS ? left : ROWS, width, across, room, sums);
        }
        parts_t all_columns = parts_of(width, across);
        for (int32_t j = 0; j < across; j += CELLS) {
            const int32_t cells = across - j < CELLS ? across - j : CELLS;
            double full[3 * CELLS] = {0};
            for (int32_t k = 0; k < cells; k++) {
                const part_t columns = next_part(&all_columns);
                const double count = (double)(rows.end - rows.first) *
                                     (double)(columns.end - columns.first);
                for (int32_t c = 0; c < 3; c++)
                    full[3 * k + c] = scale[c] * count;
            }
            divide(sums + 3 * j, full, cells, means + 3 * j);
        }
        means += numbers;
    }
}
