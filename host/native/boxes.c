#include "boxes.h"

#include <stddef.h>
#include <string.h>

/* So many bytes add up in 16 bits, which vector instructions add most of at
 * once. */
#define ROWS 257

static int32_t first_of(int32_t cell, int32_t size, int32_t cells)
{
    return (int32_t)((int64_t)cell * size / cells);
}

static int32_t end_of(int32_t cell, int32_t size, int32_t cells)
{
    int32_t first = first_of(cell, size, cells);
    int32_t next = first_of(cell + 1, size, cells);
    return next > first ? next : first + 1;
}

void boxes_sum(const uint8_t *pixels, int32_t height, int32_t width,
               int32_t down, int32_t across, uint16_t *room, uint32_t *sums)
{
    const size_t numbers = 3 * (size_t)width;
    memset(sums, 0, 3 * (size_t)down * (size_t)across * sizeof *sums);
    for (int32_t i = 0; i < down; i++, sums += 3 * across) {
        const int32_t end = end_of(i, height, down);
        for (int32_t y = first_of(i, height, down); y < end;) {
            const int32_t stop = end - y > ROWS ? y + ROWS : end;
            memset(room, 0, numbers * sizeof *room);
            for (; y < stop; y++) {
                const uint8_t *row = pixels + (size_t)y * numbers;
                for (size_t k = 0; k < numbers; k++)
                    room[k] = (uint16_t)(room[k] + row[k]);
            }
            for (int32_t j = 0; j < across; j++)
                for (int32_t x = first_of(j, width, across);
                     x < end_of(j, width, across); x++)
                    for (int c = 0; c < 3; c++)
                        sums[3 * j + c] += room[3 * x + c];
        }
    }
}
