#include "flux.h"

#include "internal/pixels.h"

#include <math.h>
#include <stddef.h>

enum { CODES = 256 };

/* Pixels about a place. */
typedef struct {
    int32_t inside, around;  /* how many in the disc, and in the ring */
    double light[3];         /* in the disc, linear */
    int32_t codes[3][CODES]; /* how often each is in the ring */
} pixels_t;

static void collect(const uint8_t *bgr, int32_t height, int32_t width,
                    const float *linear, const double *place, double radius,
                    int32_t step, pixels_t *pixels)
{
    const double reach = FLUX_RING * radius;
    const int32_t bottom = within(floor(place[1] + reach), height);
    const int32_t right = within(floor(place[0] + reach), width);
    *pixels = (pixels_t){0};
    for (int32_t y = within(ceil(place[1] - reach), height); y <= bottom;
         y += step)
        for (int32_t x = within(ceil(place[0] - reach), width); x <= right;
             x += step) {
            const uint8_t *pixel = bgr + 3 * ((ptrdiff_t)y * width + x);
            const double off = hypot(x - place[0], y - place[1]);
            if (off > reach)
                continue;
            const int is_inside = off <= radius;
            pixels->inside += is_inside;
            pixels->around += !is_inside;
            for (int c = 0; c < 3; c++)
                if (is_inside)
                    pixels->light[c] += (double)linear[pixel[c]];
                else
                    pixels->codes[c][pixel[c]]++;
        }
}

/* The light that half of so many pixels are below, and the variance of all.
 * Within a code pixels are taken to be spread evenly: of water that hardly
 * changes nearly all have the same one. */
static double median_of(const int32_t codes[CODES], int32_t count,
                        const float *linear, double *variance)
{
    double sum = 0, squares = 0;
    int32_t below = 0, before = 0;
    int median = 0;
    for (int code = 0; code < CODES; code++) {
        const double light = (double)linear[code];
        if (2 * below < count) {
            median = code;
            before = below;
        }
        below += codes[code];
        sum += codes[code] * light;
        squares += codes[code] * light * light;
    }
    const double mean = sum / fmax(count, 1);
    *variance = fmax(squares / fmax(count, 1) - mean * mean, 0);
    const double off = (0.5 * count - before) / fmax(codes[median], 1) - 0.5;
    const int other = median + (off < 0 ? -1 : 1);
    const double light = (double)linear[median];
    if (other < 0 || other >= CODES)
        return light;
    return light + fabs(off) * ((double)linear[other] - light);
}

void flux_measure(const uint8_t *bgr, int32_t height, int32_t width,
                  const float *linear, int32_t count, const double *places,
                  double radius, double *added, double *variance)
{
    const double half_pi = 1.57079632679489662;
    const int32_t step = (int32_t)fmax(ceil(radius / FLUX_STEPS), 1);
    for (ptrdiff_t i = 0; i < count; i++) {
        pixels_t pixels;
        collect(bgr, height, width, linear, places + 2 * i, radius, step,
                &pixels);
        /* A ring's median is known to half pi of its mean's variance. */
        const double each = (double)step * step;
        const double spread =
            each * each * pixels.inside *
            (1 + half_pi * pixels.inside / fmax(pixels.around, 1));
        for (ptrdiff_t c = 0; c < 3; c++) {
            double scatter;
            const double behind =
                median_of(pixels.codes[c], pixels.around, linear, &scatter);
            added[3 * i + c] =
                each * (pixels.light[c] - pixels.inside * behind);
            variance[3 * i + c] = spread * (scatter + QUANTUM);
        }
    }
}
