#include <string.h>

#include "working_image.h"

#define WIDTH METHOD_WORKING_WIDTH

/* Red and blue of a packed pixel: sums of 16 values fit beside each other. */
#define RED_BLUE UINT32_C(0x3FF003FF)
#define HALVES (UINT32_C(8) << PIXEL_RED_SHIFT | 8)

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

/* The same down the columns, and the division by 16. */
static void blur_columns(uint32_t *out, const uint32_t *above,
                         const uint32_t *here, const uint32_t *below)
{
    for (uint32_t x = 0; x < WIDTH; x++) {
        const uint32_t a = above[x], h = here[x], b = below[x];
        const uint32_t red_blue =
            (a & RED_BLUE) + 2 * (h & RED_BLUE) + (b & RED_BLUE) + HALVES;
        const uint32_t green = (a >> PIXEL_GREEN_SHIFT & 0x3FF) +
                               2 * (h >> PIXEL_GREEN_SHIFT & 0x3FF) +
                               (b >> PIXEL_GREEN_SHIFT & 0x3FF) + 8;
        out[x] = (red_blue >> 4 & UINT32_C(0x0FF000FF)) |
                 green >> 4 << PIXEL_GREEN_SHIFT;
    }
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
        blur_columns(row, above, here, below);
        uint32_t *const oldest = above;
        above = here;
        here = below;
        below = oldest;
    }
}
