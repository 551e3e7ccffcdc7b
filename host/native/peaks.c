#include "internal/summits.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Clutter grows rarer with about this power of its strength. */
#define WORTH 2.0
/* Log likelihood ratio: less is kept by no lamp that matters. */
#define LEAST_LIKENESS -5.0

/* For qsort(): the strongest first, of equal ones the first of the frame. */
static int by_strength(const void *a, const void *b)
{
    const summit_t *one = a, *other = b;
    if (one->strength > other->strength)
        return -1;
    if (one->strength < other->strength)
        return 1;
    return one->at < other->at ? -1 : 1;
}

/* The second least and the second greatest of eight values. */
static void find_seconds(const float values[8], float *second_least,
                         float *second_greatest)
{
    float low = FLT_MAX, high = -FLT_MAX;
    *second_least = FLT_MAX;
    *second_greatest = -FLT_MAX;
    for (int i = 0; i < 8; i++) {
        const float value = values[i];
        *second_least = lesser(*second_least, greater(low, value));
        low = lesser(low, value);
        *second_greatest = greater(*second_greatest, lesser(high, value));
        high = greater(high, value);
    }
}

/* See FRONT_MISSING: against all but the darkest and the brightest of the
 * places about the cell, in units of the frame's fluctuation. */
static float missing_light(const front_frame_t *frame, int at)
{
    const front_layout_t *layout = &frame->layout;
    float missing = 0, adds = 0;
    for (int c = 0; c < 3; c++) {
        const float *cell = channel(layout, frame->light, c) + at;
        const float deviation = (float)sqrt(frame->covariance[4 * c]);
        float around[8], low, high;
        look_around(cell, layout->columns, FRONT_BORDER, around);
        find_seconds(around, &low, &high);
        missing = greater(missing, (low - *cell) / deviation);
        adds = greater(adds, (*cell - high) / deviation);
    }
    return missing / (adds + missing + 1.0F);
}

static void look_at(const front_frame_t *frame, const summit_t *summit,
                    double looks[FRONT_LOOKS])
{
    const float *cell = frame->snr + summit->at;
    const int stride = frame->layout.columns;
    float around[8], ridge = -FLT_MAX, halo = 0, unused, neighbour;
    for (int radius = 2; radius <= 3; radius++) {
        look_around(cell, stride, radius, around);
        for (int i = 0; i < 4; i++)
            ridge = greater(ridge, lesser(around[i], around[i + 4]));
    }
    for (int i = 0; i < 8; i++)
        halo += around[i] / 8.0F;
    find_seconds(around, &unused, &neighbour);
    looks[FRONT_RIDGE] = (double)(ridge / summit->centre);
    looks[FRONT_HALO] = (double)(halo / summit->centre);
    looks[FRONT_NEIGHBOUR] = (double)(neighbour / summit->centre);
    looks[FRONT_SADDLE] = (double)summit->saddle;
    looks[FRONT_MISSING] = (double)missing_light(frame, summit->at);
}

/* How far along an axis the top of a parabola is, in cells, half a one at most;
 * bend: twice the middle less both sides. */
static float top_of(float behind, float ahead, float bent)
{
    const float shift = (ahead - behind) / greater(2.0F * bent, 1e-6F);
    return lesser(greater(shift, -0.5F), 0.5F);
}

/* A paraboloid through 3 x 3 values: where its top is, and how flat. */
static void measure_top(const front_frame_t *frame, const summit_t *summit,
                        double xy[2], double *flatness)
{
    float near[8];
    look_around(frame->snr + summit->at, frame->layout.columns, 1, near);
    const float xx = 2.0F * summit->centre - near[0] - near[4];
    const float yy = 2.0F * summit->centre - near[2] - near[6];
    const float cross = (near[3] + near[7] - near[1] - near[5]) / 4.0F;
    const float trace = xx + yy;
    const float determinant = xx * yy - cross * cross;
    *flatness =
        (double)(1.0F - 4.0F * determinant / greater(trace * trace, 1e-12F));
    const int cell = frame->layout.cell[summit->scale];
    const float across = top_of(near[4], near[0], xx);
    const float down = top_of(near[6], near[2], yy);
    xy[0] = (summit->column + (double)across + 0.5) * cell - 0.5;
    xy[1] = (summit->row + (double)down + 0.5) * cell - 0.5;
}

void front_chroma(const front_frame_t *frame, const double *added, int n,
                  double *chroma)
{
    for (int i = 0; i < n; i++, added += 3, chroma += 2) {
        double off[2] = {0}, along = 0;
        for (int c = 0; c < 3; c++) {
            along += frame->axes[c] * added[c];
            off[0] += frame->axes[3 + c] * added[c];
            off[1] += frame->axes[6 + c] * added[c];
        }
        const double size = sqrt(off[0] * off[0] + off[1] * off[1]);
        const double scale = atan2(size, along) / fmax(size, 1e-9);
        chroma[0] = scale * off[0];
        chroma[1] = scale * off[1];
    }
}

void front_design(const double *looks, double snr, int scale, double *row)
{
    const double strength = log(fmin(snr, FRONT_MOST_SNR));
    const double base[FRONT_BASE] = {1.0,
                                     scale == 0 ? 1.0 : 0.0,
                                     scale == 2 ? 1.0 : 0.0,
                                     scale >= 3 ? 1.0 : 0.0,
                                     strength,
                                     strength * strength};
    memcpy(row, base, sizeof(base));
    double *seen = row + FRONT_BASE;
    for (int i = 0; i < FRONT_LOOKS; i++) {
        seen[i] = fmin(fmax(looks[i], 0.0), 1.0);
        seen[FRONT_LOOKS + i] = sqrt(seen[i]);
    }
    /* At the finest scale the same number of cells is half as far, and a lamp
     * has more about it. */
    for (int i = 0; i < 2 * FRONT_LOOKS; i++) {
        seen[2 * FRONT_LOOKS + i] = seen[i] * strength;
        seen[4 * FRONT_LOOKS + i] = scale == 0 ? seen[i] : 0.0;
    }
}

/* Natural log of how much likelier such a peak is a lamp than clutter: two
 * logistic regressions give it, for the ratio of the posterior odds with the
 * looks to those without is the ratio of the densities of the looks. */
static double likeness_of(const double *looks, double snr, int scale,
                          const double *with_looks, const double *without)
{
    double row[FRONT_DESIGN], sum = 0;
    front_design(looks, snr, scale, row);
    for (int i = 0; i < FRONT_DESIGN; i++)
        sum += with_looks[i] * row[i];
    for (int i = 0; i < FRONT_BASE; i++)
        sum -= without[i] * row[i];
    return sum;
}

/* Chooses the peaks that are likelier lamps than clutter as strong is common,
 * of n peaks. */
static void choose_promising(const double *snr, const double *likeness, int n,
                             uint8_t *promising)
{
    double score[FRONT_MAX_PEAKS];
    for (int i = 0; i < n; i++)
        score[i] = likeness[i] < LEAST_LIKENESS
                       ? -DBL_MAX
                       : likeness[i] + WORTH * log(snr[i]);
    for (int i = 0; i < n; i++) {
        int better = 0;
        for (int j = 0; j < n; j++)
            better += score[j] > score[i] || (j < i && score[j] >= score[i]);
        promising[i] = score[i] > -DBL_MAX && better < FRONT_MAX_PROMISING;
    }
}

/* Of the span of a radius to both sides of a place, how much is in 0..size. */
static double share_inside(double place, double radius, double size)
{
    const double seen = fmin(place + radius, size) - fmax(place - radius, 0.0);
    return fmax(seen, 0.0) / (2 * radius);
}

static double inside_of(const front_layout_t *layout, const double xy[2])
{
    const double width = layout->width[0] * layout->cell[0];
    const double height = layout->height[0] * layout->cell[0];
    const double radius = FRONT_NEIGHBOURHOOD * sqrt(width * height);
    return share_inside(xy[0], radius, width) *
           share_inside(xy[1], radius, height);
}

static void describe(const front_frame_t *frame, const summit_t *summit,
                     front_peaks_t *peaks, int k)
{
    const front_layout_t *layout = &frame->layout;
    const int best = frame->best[summit->at];
    float light[3], added[3];
    double exact[3];
    for (int c = 0; c < 3; c++) {
        light[c] = channel(layout, frame->light, c)[summit->at];
        added[c] = channel(layout, frame->added, c)[summit->at];
        exact[c] = (double)added[c];
    }
    const float excess = filtered(frame->weights + 3 * best,
                                  least_weight(light[0], light[1], light[2]),
                                  added[0], added[1], added[2]);
    double *looks = peaks->looks + k * FRONT_LOOKS;
    look_at(frame, summit, looks);
    measure_top(frame, summit, peaks->xy + 2 * k, &looks[FRONT_FLATNESS]);
    peaks->inside[k] = inside_of(layout, peaks->xy + 2 * k);
    front_chroma(frame, exact, 1, peaks->chroma + 2 * k);
    peaks->snr[k] = (double)summit->strength;
    peaks->noise[k] = (double)(greater(excess, 1e-6F) / summit->centre);
}

void front_find(const front_frame_t *frame, const double *with_looks,
                const double *without, front_peaks_t *peaks)
{
    summit_t summits[2 * MAX_SUMMITS];
    const int n = summits_find(frame, summits);
    qsort(summits, (size_t)n, sizeof(summit_t), by_strength);
    memset(peaks->count, 0, sizeof(peaks->count));
    for (int i = 0; i < n; i++) {
        const int scale = summits[i].scale;
        if (peaks->count[scale] == FRONT_MAX_PEAKS)
            continue;
        const int k = FRONT_MAX_PEAKS * scale + peaks->count[scale]++;
        describe(frame, &summits[i], peaks, k);
        peaks->likeness[k] =
            likeness_of(peaks->looks + k * FRONT_LOOKS, peaks->snr[k], scale,
                        with_looks, without);
    }
    for (int scale = 0; scale < frame->layout.scales; scale++) {
        const int first = FRONT_MAX_PEAKS * scale;
        choose_promising(peaks->snr + first, peaks->likeness + first,
                         peaks->count[scale], peaks->promising + first);
    }
}
