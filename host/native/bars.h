/* What is bright between lamps: chromadock.robust's frame/bars.py says what
 * for.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef BARS_H
#define BARS_H

#include <stdint.h>

/* Places on the way from one lamp to another that are looked at, evenly over
 * its middle, from this share of the way to what is left of it: there a lamp's
 * own halo is faint. What crosses the way is no bar: the median of all
 * counts. */
#define BARS_ALONG 16
#define BARS_FROM 0.3

/* Across the way, in widths of the smoothing: the light is looked at so far to
 * either side, so many times a width, and what is farther than BARS_BESIDE is
 * what stands behind a bar. Beyond two widths of the wider smoothing is a
 * twentieth of its weight. */
#define BARS_REACH 4
#define BARS_PER_WIDTH 2
#define BARS_BESIDE 3.5

/* The slope of the light at each lamp, smoothed by a difference of Gaussians,
 * that bars would make which lead from it to others, end there, and are as
 * bright as the middle of the way, but for what the lamps themselves shine on
 * it: as much as on the first one's other side. What is dark makes none. Of
 * lamps in a row each has its bar to the next alone.
 *
 * bgr: height x width x 3 codes. linear: the light of each of 256 codes.
 * weights: what each channel counts, BGR. places: count x 2, x and y in pixels.
 * widths: count standard deviations of the smoothing, pixels; its surround is
 * twice as wide. slopes: receives count x 2, light per pixel. */
void bars_slopes(const uint8_t *bgr, int32_t height, int32_t width,
                 const float *linear, const float *weights, int32_t count,
                 const double *places, const double *widths, double *slopes);

#endif
