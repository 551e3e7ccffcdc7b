#include "smooth.h"

#include <string.h>

#include "pixel.h"

#define WIDTH WORKING_WIDTH

/* Sums of all three channels at once, up to 16 * 255 each.  In `all` red and
 * green have grown into each other; without `red_blue`, green is left. */
typedef struct {
    uint32_t all, red_blue;
} sum_t;

static inline sum_t plus(sum_t a, sum_t b)
{
    return (sum_t){a.all + b.all, a.red_blue + b.red_blue};
}

/* above + 2 * here + below, and a quarter of the 8 that rounds the sixteenth:
 * at most 1022, within the ten bits of a channel.  `above` gets what stands
 * here, for the next row. */
static inline sum_t column(uint32_t *above, uint32_t here, uint32_t below)
{
    const uint32_t sum = *above + 2 * here + below + pixel_pack(2, 2, 2);
    *above = here;
    return (sum_t){sum, sum & UINT32_C(0x3FF003FF)};
}

static inline uint32_t sixteenth(sum_t sum)
{
    const uint32_t green = sum.all - sum.red_blue;
    return ((sum.red_blue & UINT32_C(0xFF000FF0)) |
            (green & UINT32_C(0x003FC000))) >>
           4;
}

/* One row in place: two columns in turns, each twice as heavy as its
 * neighbours by being added to either. */
static void smooth_row(uint32_t *row, uint32_t *above, const uint32_t *below)
{
    sum_t even = column(above, row[0], below[0]);
    sum_t left = plus(even, even), right;
    for (uint32_t x = 1; x < WIDTH - 1; x += 2) {
        const sum_t odd = column(above + x, row[x], below[x]);
        right = plus(even, odd);
        row[x - 1] = sixteenth(plus(left, right));
        even = column(above + x + 1, row[x + 1], below[x + 1]);
        left = plus(odd, even);
        row[x] = sixteenth(plus(right, left));
    }
    const sum_t last =
        column(above + WIDTH - 1, row[WIDTH - 1], below[WIDTH - 1]);
    right = plus(even, last);
    row[WIDTH - 2] = sixteenth(plus(left, right));
    row[WIDTH - 1] = sixteenth(plus(right, plus(last, last)));
}

void smoothed_open(smoothed_t *smoothed, const frame_t *frame)
{
    working_image_open(&smoothed->working, frame);
}

void smoothed_rows(void *smoothed, row_taker_t *take, void *context)
{
    smoothed_t *const s = smoothed;
    uint32_t *here = s->row[0], *below = s->row[1];
    working_image_row(&s->working, 0, here);
    memcpy(s->above, here, sizeof s->above);
    for (uint32_t y = 1; y < WORKING_HEIGHT; y++) {
        working_image_row(&s->working, y, below);
        smooth_row(here, s->above, below);
        take(context, here);
        uint32_t *const taken = here;
        here = below;
        below = taken;
    }
    memcpy(below, here, sizeof s->above);
    smooth_row(here, s->above, below);
    take(context, here);
}
