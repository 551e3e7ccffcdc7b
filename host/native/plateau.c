#include "plateau.h"

#include "internal/pixels.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Steps on the line through two markers: from as far before the first of them
 * as the second is behind it, to as far behind the second. */
enum {
    STEPS = 3 * PLATEAU_SAMPLES,
    FIRST_END = PLATEAU_SAMPLES,
    SECOND_END = 2 * PLATEAU_SAMPLES
};

typedef struct {
    const uint8_t *bgr;
    int32_t height, width, sense;
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
                sum[c] += picture->sense > 0 ? pixel[c] : UINT8_MAX - pixel[c];
        }
    for (int c = 0; c < 3; c++)
        mean[c] = (2 * sum[c] + 9) / 18;
}

static int lesser(int a, int b)
{
    return a < b ? a : b;
}

/* How bright light is in a colour: its part along that vector of (B, G, R). */
static double along(const double colour[3], const int light[3])
{
    return colour[0] * light[0] + colour[1] * light[1] + colour[2] * light[2];
}

/* Whether some of the light between the ends is darker in a colour than both,
 * by so much that it is no noise; length: that of the colour's vector. */
static bool has_gap(int light[STEPS + 1][3], const double colour[3],
                    double length)
{
    const double ends =
        fmin(along(colour, light[FIRST_END]), along(colour, light[SECOND_END]));
    double between = INFINITY;
    for (int i = FIRST_END; i <= SECOND_END; i++)
        between = fmin(between, along(colour, light[i]));
    const double dip = fmin(PLATEAU_DIP, PLATEAU_LEAST_DIP * length);
    return ends - between >= dip * length;
}

/* Whether it is as bright between two places as at both. */
static bool is_level(const picture_t *picture, const double *from,
                     const double *to)
{
    int light[STEPS + 1][3], beyond[3] = {UINT8_MAX, UINT8_MAX, UINT8_MAX};
    for (int i = 0; i <= STEPS; i++) {
        const double step = i * (3.0 / STEPS) - 1.0;
        mean_about(picture, from[0] + step * (to[0] - from[0]),
                   from[1] + step * (to[1] - from[1]), light[i]);
        if (i < FIRST_END || i > SECOND_END)
            for (int c = 0; c < 3; c++)
                beyond[c] = lesser(beyond[c], light[i][c]);
    }
    double excess[3], square = 0;
    bool stands_out = false;
    for (int c = 0; c < 3; c++) {
        const int end = lesser(light[FIRST_END][c], light[SECOND_END][c]);
        excess[c] = fmax(end - beyond[c], 0);
        square += excess[c] * excess[c];
        if (excess[c] < PLATEAU_LEAST_EXCESS)
            continue;
        stands_out = true;
        double channel[3] = {0};
        channel[c] = excess[c];
        if (has_gap(light, channel, excess[c]))
            return false;
    }
    return stands_out && !has_gap(light, excess, sqrt(square));
}

int32_t plateau_on_one_thing(const uint8_t *bgr, int32_t height, int32_t width,
                             int32_t count, const double *places, int32_t sense)
{
    const picture_t picture = {bgr, height, width, sense};
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
