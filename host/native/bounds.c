#include "internal/searching.h"
#include "internal/vectors.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Rarity of a peak at most, with any others in a set of so many. */
static double most_rarity(const evidence_frame_t *frame, int32_t index,
                          int32_t size)
{
    const peak_t *peak = &frame->peaks[index];
    int32_t others = size - 1, count = frame->count - size;
    int32_t stronger = index > others ? index - others : 0;
    int32_t nearby = peak->stronger > others ? peak->stronger - others : 0;
    double strongest = count > 0 ? frame->peaks[size].height : 0;
    double most = frame->heights - peak->height, least = frame->heights;
    for (int32_t i = 0; i < size; i++)
        least -= frame->peaks[i].height;
    return larger(
        evidence_rarity(frame, peak, stronger, nearby, count, most, strongest),
        evidence_rarity(frame, peak, stronger, nearby, count, larger(least, 0),
                        strongest));
}

static int descending(const void *a, const void *b)
{
    double one = *(const double *)a, other = *(const double *)b;
    return (one < other) - (one > other);
}

/* Keep the largest values of each column, in falling order: there is room for
 * so many rows, and a row of values is one more. */
static inline void keep_largest(double largest[][SEARCH_MAX_PROMISING],
                                int32_t room, const double *values,
                                int32_t count)
{
    double rest[SEARCH_MAX_PROMISING];
    for (int32_t i = 0; i < count; i++)
        rest[i] = values[i];
    for (int32_t k = 0; k < room; k++) {
        double *restrict kept = largest[k];
        for (int32_t i = 0; i < count; i++) {
            const double more = larger(kept[i], rest[i]);
            rest[i] = smaller(kept[i], rest[i]);
            kept[i] = more;
        }
    }
}

/* How like the colours of any two peaks are, and of each peak the sum over the
 * likest, which are as many as markers: itself mostly one of them. */
WIDE_VECTORS static void compare_colours(search_bounds_t *bounds,
                                         double together[SEARCH_MAX_PROMISING])
{
    const int32_t count = bounds->count, markers = bounds->markers;
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    double variance[SEARCH_MAX_PROMISING];
    double likest[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    for (int32_t i = 0; i < count; i++) {
        const peak_t *peak = bounds_peak(bounds, i);
        x[i] = peak->chroma_x;
        y[i] = peak->chroma_y;
        variance[i] = peak->variance;
        together[i] = 0;
    }
    for (int32_t k = 0; k < markers; k++)
        for (int32_t i = 0; i < count; i++)
            likest[k][i] = 0;
    for (int32_t j = 0; j < count; j++) {
        double *restrict same = bounds->colour[j];
        for (int32_t i = 0; i < count; i++) {
            const double apart = square(x[i] - x[j]) + square(y[i] - y[j]);
            same[i] = student(apart, variance[i] + variance[j]);
        }
        keep_largest(likest, markers, same, count);
    }
    for (int32_t k = 0; k < markers; k++)
        for (int32_t i = 0; i < count; i++)
            together[i] += likest[k][i];
}

/* What the colour of each peak is worth if it is that of each other, and if it
 * is that of so many others.  The density of clutter's chroma at a peak is
 * least if the others of its set are those that are likest to its colour. */
WIDE_VECTORS static void prepare_colours(search_bounds_t *bounds)
{
    const evidence_frame_t *frame = bounds->frame;
    const int32_t count = bounds->count, markers = bounds->markers;
    const double disturbed = frame->constants->colour_disturbed;
    double together[SEARCH_MAX_PROMISING];
    compare_colours(bounds, together);
    for (int32_t k = 0; k < markers; k++)
        for (int32_t i = 0; i < count; i++)
            bounds->nearest_colours[k][i] = k == 0 ? 1 : 0;
    for (int32_t j = 0; j < count; j++) {
        const peak_t *peak = bounds_peak(bounds, j);
        const double clutter = evidence_clutter_colour(
            frame, peak, peak->everywhere - together[j], frame->count - markers,
            peak->nearby - together[j], peak->around - 1);
        double *restrict ratios = bounds->colour[j];
        for (int32_t i = 0; i < count; i++)
            ratios[i] = colour_ratio(disturbed, ratios[i], clutter);
        ratios[j] = 0;
        keep_largest(bounds->nearest_colours + 1, markers - 1, ratios, count);
        ratios[j] = 1;
    }
    for (int32_t k = 1; k < markers; k++)
        for (int32_t i = 0; i < count; i++)
            bounds->nearest_colours[k][i] *= bounds->nearest_colours[k - 1][i];
    for (int32_t i = 0; i < count; i++) {
        const double most = log(bounds->nearest_colours[markers - 1][i]);
        bounds->log_colours[i] = most;
        bounds->most_log_colours =
            i == 0 ? most : larger(bounds->most_log_colours, most);
    }
}

size_t search_bounds_size(void)
{
    return sizeof(search_bounds_t);
}

int32_t search_prepare(search_bounds_t *bounds, const evidence_frame_t *frame,
                       int32_t markers, int32_t promising_count,
                       const int32_t *promising)
{
    if (promising_count > SEARCH_MAX_PROMISING)
        return -1;
    bounds->frame = frame;
    bounds->markers = markers;
    bounds->count = promising_count;
    if (promising_count < markers)
        return 0;
    /* The clutter looks least like lamps without those that do most. */
    double sorted[EVIDENCE_MAX_PEAKS] = {0}, ratios = frame->ratios;
    for (int32_t i = 0; i < frame->count; i++)
        sorted[i] = frame->peaks[i].ratio;
    qsort(sorted, (size_t)frame->count, sizeof(double), descending);
    for (int32_t i = 0; i < markers; i++)
        ratios -= sorted[i];
    double usual =
        evidence_log_mean_ratio(frame, frame->count - markers, ratios);
    for (int32_t i = 0; i < promising_count; i++) {
        const peak_t *peak = &frame->peaks[promising[i]];
        bounds->promising[i] = promising[i];
        bounds->place_x[i] = peak->x;
        bounds->place_y[i] = peak->y;
        bounds->rarity[i] =
            peak->likeness - usual + most_rarity(frame, promising[i], markers);
        bounds->rarest[i + 1] = bounds->rarity[i];
    }
    bounds->rarest[0] = 0;
    qsort(bounds->rarest + 1, (size_t)promising_count, sizeof(double),
          descending);
    for (int32_t i = 0; i < promising_count; i++)
        bounds->rarest[i + 1] += bounds->rarest[i];
    prepare_colours(bounds);
    return 0;
}

void bounds_of_strengths(search_t *search)
{
    const evidence_constants_t *constants = search->bounds->frame->constants;
    const int32_t markers = search->dock->markers;
    /* Markers that no noise disturbs, all as strong, are as dense as any. */
    double weight = 1 / square(constants->strength_spread), all = 0;
    double log_density = 0.5 * log(weight / (2 * PI));
    strengths_t strengths = {0};
    for (int32_t k = 1; k <= markers; k++) {
        add_strength(&strengths, 0, weight, log_density,
                     search->dock->along[k - 1]);
        all = evidence_log_alike(constants, &strengths);
        search->strengths_left[k] = -all;
    }
    for (int32_t k = 1; k <= markers; k++)
        search->strengths_left[k] += all;
    search->strengths = all;
}

double bounds_beside(const search_t *search, int32_t k)
{
    const search_bounds_t *bounds = search->bounds;
    return search->strengths + bounds->rarest[bounds->markers - k] +
           bounds->most_log_colours + ROUNDING;
}

double bounds_looks(const search_t *search, int32_t k,
                    const strengths_t *strengths)
{
    const search_bounds_t *bounds = search->bounds;
    int32_t others = bounds->markers - k;
    double rarity = bounds->rarest[others], colour = DBL_MIN;
    for (int32_t i = 0; i < k; i++) {
        double common = bounds->nearest_colours[others][search->set[i]];
        for (int32_t j = 0; j < k; j++)
            common *= bounds->colour[search->set[j]][search->set[i]];
        colour = larger(colour, common);
        rarity += bounds->rarity[search->set[i]];
    }
    return evidence_log_alike(bounds->frame->constants, strengths) +
           search->strengths_left[k] + rarity + log(colour);
}
