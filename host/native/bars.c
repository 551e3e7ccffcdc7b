#include "bars.h"

#include "internal/pixels.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { ACROSS = 2 * BARS_REACH * BARS_PER_WIDTH + 1 };

typedef struct {
    const uint8_t *bgr;
    int32_t height, width;
    const float *linear, *weights;
} picture_t;

/* The slope across the end of a line of light that is as bright as this says:
 * a step smoothed by a Gaussian of width w slopes by 1 / (w root 2 pi). In
 * units of a width, so that the same weights are any lamp's. */
static void weigh_across(double across[ACROSS])
{
    const double root_two_pi = 2.50662827463100050;
    double narrow[ACROSS], wide[ACROSS], beside[ACROSS];
    double of_narrow = 0, of_wide = 0, of_beside = 0;
    for (int k = 0; k < ACROSS; k++) {
        const double off = (double)k / BARS_PER_WIDTH - BARS_REACH;
        of_narrow += narrow[k] = exp(-off * off / 2);
        of_wide += wide[k] = exp(-off * off / 8);
        of_beside += beside[k] = fabs(off) >= BARS_BESIDE;
    }
    for (int k = 0; k < ACROSS; k++)
        across[k] = (narrow[k] / of_narrow - wide[k] / of_wide / 2 -
                     beside[k] / of_beside / 2) /
                    root_two_pi;
}

static double middle_of(double values[BARS_ALONG])
{
    for (int i = 1; i < BARS_ALONG; i++) {
        const double value = values[i];
        int at = i;
        for (; at > 0 && values[at - 1] > value; at--)
            values[at] = values[at - 1];
        values[at] = value;
    }
    return (values[BARS_ALONG / 2 - 1] + values[BARS_ALONG / 2]) / 2;
}

/* The light of the pixel that a place is in, through weights. */
static double light_of(const picture_t *picture, double x, double y)
{
    const ptrdiff_t column = within(x + 0.5, picture->width);
    const ptrdiff_t row = within(y + 0.5, picture->height);
    const uint8_t *pixel = picture->bgr + 3 * (row * picture->width + column);
    double light = 0;
    for (int c = 0; c < 3; c++)
        light +=
            (double)picture->weights[c] * (double)picture->linear[pixel[c]];
    return light;
}

/* The light of a line that crosses the way from one place to another, such a
 * share of it on: less what stands behind a bar. */
static double light_across(const picture_t *picture, const double *from,
                           const double step[2], const double side[2],
                           double way, const double across[ACROSS])
{
    double light = 0;
    for (int k = 0; k < ACROSS; k++) {
        const double off = k - ACROSS / 2;
        light += across[k] * light_of(picture,
                                      from[0] + way * step[0] + off * side[0],
                                      from[1] + way * step[1] + off * side[1]);
    }
    return light;
}

/* The slope that a bar along the way from one lamp to another makes there,
 * times the width. What both lamps' own halos add is as much as that of the
 * first one adds on its other side, as far from it as either lamp is. */
static double slope_along(const picture_t *picture, const double *from,
                          const double step[2], const double side[2],
                          const double across[ACROSS])
{
    double along[BARS_ALONG];
    for (int n = 0; n < BARS_ALONG; n++) {
        const double way =
            BARS_FROM + (1 - 2 * BARS_FROM) * (n + 0.5) / BARS_ALONG;
        const double halos =
            light_across(picture, from, step, side, -way, across) +
            light_across(picture, from, step, side, way - 1, across);
        along[n] = light_across(picture, from, step, side, way, across) -
                   fmax(halos, 0);
    }
    return fmax(middle_of(along), 0);
}

/* Whether a bar from one of the lamps to another ends at a third before, which
 * stands in what is looked at: then it is that one's bar. */
static bool is_crossed(int32_t count, const double *places, ptrdiff_t i,
                       ptrdiff_t j, double reach)
{
    const double *from = places + 2 * i, *to = places + 2 * j;
    const double x = to[0] - from[0], y = to[1] - from[1];
    const double far = hypot(x, y);
    for (ptrdiff_t k = 0; k < count; k++) {
        const double u = places[2 * k] - from[0];
        const double v = places[2 * k + 1] - from[1];
        const double way = (u * x + v * y) / far;
        if (k != i && k != j && way > 0 && way < far &&
            fabs(u * y - v * x) / far < reach)
            return true;
    }
    return false;
}

void bars_slopes(const uint8_t *bgr, int32_t height, int32_t width,
                 const float *linear, const float *weights, int32_t count,
                 const double *places, const double *widths, double *slopes)
{
    const picture_t picture = {bgr, height, width, linear, weights};
    double across[ACROSS];
    weigh_across(across);
    for (ptrdiff_t i = 0; i < count; i++) {
        const double *from = places + 2 * i;
        slopes[2 * i] = slopes[2 * i + 1] = 0;
        for (ptrdiff_t j = 0; j < count; j++) {
            const double step[] = {places[2 * j] - from[0],
                                   places[2 * j + 1] - from[1]};
            const double far = hypot(step[0], step[1]);
            if (!(far > 0) ||
                is_crossed(count, places, i, j, BARS_REACH * widths[i]))
                continue;
            const double stride = widths[i] / BARS_PER_WIDTH / far;
            const double side[] = {-stride * step[1], stride * step[0]};
            const double slope =
                slope_along(&picture, from, step, side, across) / widths[i];
            slopes[2 * i] += slope * step[0] / far;
            slopes[2 * i + 1] += slope * step[1] / far;
        }
    }
}
