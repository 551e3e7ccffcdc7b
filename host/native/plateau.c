#include "plateau.h"

#include "internal/pixels.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Steps on the line through two markers: from as far before the first of them
 * as the second is behind it, to as far behind the second. */
enum { STEPS = 3 * PLATEAU_SAMPLES };

typedef struct {
    const uint8_t *bgr;
    int32_t height, width;
} picture_t;

/* Means of the 3 x 3 pixels about a place, to the nearest code; beyond the
 * border are the pixels nearest to it. */
static void mean_about(const picture_t *picture, double x, double y,
                       int mean[3])
{
    const int32_t column = within(rint(x), picture->width);
    const int32_t row = within(rint(y), picture->height);
    int sum[3] = {0};
    for (int32_t down = -1; down <= 1; down++)
        for (int32_t across = -1; across <= 1; across++) {
            const ptrdiff_t at = within(row + down, picture->height);
            const uint8_t *pixel =
                picture->bgr + 3 * (at * picture->width +
                                    within(column + across, picture->width));
            for (int c = 0; c < 3; c++)
                sum[c] += pixel[c];
        }
    for (int c = 0; c < 3; c++)
        mean[c] = (2 * sum[c] + 9) / 18;
}

static int lesser(int a, int b)
{
    return a < b ? a : b;
}

/* Whether it is as bright between two places as at both. */
static bool is_level(const picture_t *picture, const double *from,
                     const double *to)
{
    int ends[3], beyond[3], between[3];
    for (int c = 0; c < 3; c++)
        ends[c] = beyond[c] = between[c] = UINT8_MAX;
    for (int i = 0; i <= STEPS; i++) {
        const double step = i * (3.0 / STEPS) - 1.0;
        int light[3];
        mean_about(picture, from[0] + step * (to[0] - from[0]),
                   from[1] + step * (to[1] - from[1]), light);
        const bool is_end = i == PLATEAU_SAMPLES || i == 2 * PLATEAU_SAMPLES;
        const bool is_beyond = i < PLATEAU_SAMPLES || i > 2 * PLATEAU_SAMPLES;
        int *darkest = is_beyond ? beyond : between;
        for (int c = 0; c < 3; c++) {
            darkest[c] = lesser(darkest[c], light[c]);
            if (is_end)
                ends[c] = lesser(ends[c], light[c]);
        }
    }
    bool stands_out = false;
    for (int c = 0; c < 3; c++) {
        const double excess = ends[c] - beyond[c];
        const double dip =
            fmin(PLATEAU_DIP, fmax(PLATEAU_LEAST_DIP * excess, 0));
        if (!(ends[c] - between[c] < dip))
            return false;
        stands_out |= excess >= PLATEAU_LEAST_EXCESS;
    }
    return stands_out;
}

int32_t plateau_on_one_thing(const uint8_t *bgr, int32_t height, int32_t width,
                             int32_t count, const double *places)
{
    const picture_t picture = {bgr, height, width};
    for (int32_t i = 0; i < count; i++) {
        const double *own = places + (ptrdiff_t)2 * i, *nearest = NULL;
        double least = INFINITY;
        for (int32_t j = 0; j < count; j++) {
            const double *other = places + (ptrdiff_t)2 * j;
            const double apart = hypot(other[0] - own[0], other[1] - own[1]);
            if (j != i && apart < least) {
                least = apart;
                nearest = other;
            }
        }
        if (nearest != NULL && is_level(&picture, own, nearest))
            return 1;
    }
    return 0;
}
