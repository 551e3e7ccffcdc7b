#include "internal/looks.h"
#include "internal/vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Clutter grows rarer with about this power of its strength. */
#define WORTH 2.0

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

/* Chooses the peaks that are likelier lamps than clutter as strong is common,
 * of n peaks. */
WIDE_VECTORS static void choose_promising(const double *snr,
                                          const double *likeness, int n,
                                          uint8_t *promising)
{
    double score[FRONT_MAX_PEAKS];
    for (int i = 0; i < n; i++)
        score[i] = likeness[i] + WORTH * log(snr[i]);
    for (int i = 0; i < n; i++) {
        int64_t better = 0;
        for (int j = 0; j < i; j++)
            better += score[j] >= score[i];
        for (int j = i + 1; j < n; j++)
            better += score[j] > score[i];
        promising[i] = better < FRONT_MAX_PROMISING;
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

/* What the filter that answers most to a cell says of it, which of what takes
 * light away has not been kept. */
static float excess_of(const front_frame_t *frame, int at, const float light[3],
                       const float added[3])
{
    if (frame->sense > 0)
        return filtered(frame->weights + 3 * frame->best[at],
                        least_weight(light[0], light[1], light[2]), added[0],
                        added[1], added[2]);
    float most = 0;
    for (int hue = 0; hue < FRONT_HUES; hue++)
        most = greater(most, filtered(frame->weights + 3 * hue, -FLT_MAX,
                                      added[0], added[1], added[2]));
    return most;
}

static void describe(const front_frame_t *frame,
                     const ring_t rings[LOOKS_RINGS], const summit_t *summit,
                     front_peaks_t *peaks, int k)
{
    const front_layout_t *layout = &frame->layout;
    float light[3], added[3];
    double exact[3];
    for (int c = 0; c < 3; c++) {
        light[c] = channel(layout, frame->light, c)[summit->at];
        added[c] =
            (float)frame->sense * channel(layout, frame->added, c)[summit->at];
        exact[c] = (double)added[c];
    }
    const float excess = excess_of(frame, summit->at, light, added);
    double flatness;
    measure_top(frame, summit, peaks->xy + 2 * k, &flatness);
    looks_at(frame, rings, summit, peaks->xy + 2 * k, flatness,
             peaks->looks + k * FRONT_LOOKS);
    peaks->inside[k] = inside_of(layout, peaks->xy + 2 * k);
    front_chroma(frame, exact, 1, peaks->chroma + 2 * k);
    peaks->snr[k] = (double)summit->strength;
    peaks->noise[k] = (double)(greater(excess, 1e-6F) / summit->centre);
}

void front_find(const front_frame_t *frame, const front_network_t *network,
                front_peaks_t *peaks)
{
    summit_t summits[2 * MAX_SUMMITS];
    ring_t rings[LOOKS_RINGS];
    looks_prepare(frame->layout.columns, rings);
    const int n = summits_find(frame, summits);
    qsort(summits, (size_t)n, sizeof(summit_t), by_strength);
    memset(peaks->count, 0, sizeof(peaks->count));
    for (int i = 0; i < n; i++) {
        const int scale = summits[i].scale;
        if (peaks->count[scale] == FRONT_MAX_PEAKS ||
            (frame->sense < 0 && !looks_dark(frame, summits[i].at)))
            continue;
        const int k = FRONT_MAX_PEAKS * scale + peaks->count[scale]++;
        describe(frame, rings, &summits[i], peaks, k);
        peaks->likeness[k] = looks_likeness(
            network, peaks->looks + k * FRONT_LOOKS, peaks->snr[k], scale);
    }
    for (int scale = 0; scale < frame->layout.scales; scale++) {
        const int first = FRONT_MAX_PEAKS * scale;
        choose_promising(peaks->snr + first, peaks->likeness + first,
                         peaks->count[scale], peaks->promising + first);
    }
}
