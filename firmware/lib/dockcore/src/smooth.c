#include <string.h>

#include "working_image.h"

#define WIDTH METHOD_WORKING_WIDTH

/* left + 2 * here + right of a row, all three channels at once: at most 1020,
 * which fits the ten bits that each has. */
static void blur_row(uint32_t *out, const uint32_t *row)
{
    uint32_t left = row[0], here = row[0];
    for (uint32_t x = 0; x < WIDTH - 1; x++) {
        const uint32_t right = row[x + 1];
        out[x] = left + 2 * here + right;
        left = here;
        here = right;
    }
    out[WIDTH - 1] = left + 3 * here;
}

/* Half of a + b, rounded down, in each ten-bit field. */
static inline uint32_t half_sum(uint32_t a, uint32_t b)
{
    return (a & b) + (((a ^ b) & UINT32_C(0x3FEFFBFE)) >> 1);
}

/* (above + 2 * here + below + 8) / 16, rounded down, in each field.  Halving
 * on the way keeps ten bits enough and, as floor(floor(x) / n) = floor(x / n),
 * changes nothing. */
static inline uint32_t blur_column(uint32_t above, uint32_t here,
                                   uint32_t below)
{
    const uint32_t two = pixel_pack(2, 2, 2);
    const uint32_t quarter = half_sum(half_sum(above, below), here);
    return (quarter + two) >> 2 & pixel_pack(0xFF, 0xFF, 0xFF);
}

void working_image_smooth(working_image_t *image)
{
    uint32_t lines[3][WIDTH];
    uint32_t *above = lines[0], *here = lines[1], *below = lines[2];
    blur_row(here, image->pixel);
    memcpy(above, here, sizeof lines[0]);
    for (uint32_t y = 0; y < METHOD_WORKING_HEIGHT; y++) {
        uint32_t *row = image->pixel + y * WIDTH;
        if (y + 1 < METHOD_WORKING_HEIGHT)
            blur_row(below, row + WIDTH);
        else
            memcpy(below, here, sizeof lines[0]);
        for (uint32_t x = 0; x < WIDTH; x++)
            row[x] = blur_column(above[x], here[x], below[x]);
        uint32_t *const oldest = above;
        above = here;
        here = below;
        below = oldest;
    }
}
