#include "internal/searching.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Rarity of a peak at most, with any others in a set of so many. */
static double most_rarity(const frame_t *frame, int32_t index, int32_t size)
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

/* Keep the largest values there are room for, in order, with one more. */
static void keep_largest(double *largest, int32_t room, double value)
{
    for (int32_t i = 0; i < room; i++) {
        if (value > largest[i]) {
            double smaller = largest[i];
            largest[i] = value;
            value = smaller;
        }
    }
}

/* Density of clutter's chroma at a peak at least: if the others in a set of so
 * many are those that are likest to its colour. */
static double least_clutter_colour(const search_t *search, const peak_t *peak)
{
    int32_t size = search->dock->markers;
    double likest[SEARCH_MAX_PROMISING] = {0}, together = 0;
    for (int32_t i = 0; i < search->count; i++)
        keep_largest(likest, size, same_colour(peak_at(search, i), peak));
    for (int32_t i = 0; i < size; i++)
        together += likest[i];
    const frame_t *frame = &search->frame;
    return evidence_clutter_colour(frame, peak, peak->everywhere - together,
                                   frame->count - size, peak->nearby - together,
                                   peak->around - 1);
}

void search_prepare_bounds(search_t *search)
{
    const frame_t *frame = &search->frame;
    const evidence_constants_t *constants = frame->constants;
    int32_t markers = search->dock->markers;
    /* The clutter looks least like lamps without those that do most. */
    double sorted[EVIDENCE_MAX_PEAKS] = {0}, ratios = frame->ratios;
    for (int32_t i = 0; i < frame->count; i++)
        sorted[i] = frame->peaks[i].ratio;
    qsort(sorted, (size_t)frame->count, sizeof(double), descending);
    for (int32_t i = 0; i < markers; i++)
        ratios -= sorted[i];
    double usual =
        evidence_log_mean_ratio(frame, frame->count - markers, ratios);
    for (int32_t i = 0; i < search->count; i++) {
        search->rarity[i] = peak_at(search, i)->likeness - usual +
                            most_rarity(frame, search->promising[i], markers);
        search->rarest[i + 1] = search->rarity[i];
    }
    search->rarest[0] = 0;
    qsort(search->rarest + 1, (size_t)search->count, sizeof(double),
          descending);
    for (int32_t i = 0; i < search->count; i++)
        search->rarest[i + 1] += search->rarest[i];
    for (int32_t j = 0; j < search->count; j++) {
        const peak_t *peak = peak_at(search, j);
        double clutter = least_clutter_colour(search, peak);
        for (int32_t i = 0; i < search->count; i++) {
            double same = same_colour(peak_at(search, i), peak);
            search->colour[i][j] =
                i == j ? 1 : evidence_colour_ratio(frame, same, clutter);
        }
    }
    for (int32_t i = 0; i < search->count; i++) {
        double *nearest = search->nearest_colours[i];
        nearest[0] = 1;
        for (int32_t k = 1; k < markers; k++)
            nearest[k] = 0;
        for (int32_t j = 0; j < search->count; j++)
            if (j != i)
                keep_largest(nearest + 1, markers - 1, search->colour[i][j]);
        for (int32_t k = 1; k < markers; k++)
            nearest[k] *= nearest[k - 1];
    }
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
}

double search_hoped(const search_t *search, int32_t k,
                    const strengths_t *strengths)
{
    int32_t others = search->dock->markers - k;
    double rarity = search->rarest[others], colour = DBL_MIN;
    for (int32_t i = 0; i < k; i++) {
        const double *ratios = search->colour[search->set[i]];
        double common = search->nearest_colours[search->set[i]][others];
        for (int32_t j = 0; j < k; j++)
            common *= ratios[search->set[j]];
        colour = larger(colour, common);
        rarity += search->rarity[search->set[i]];
    }
    return evidence_log_alike(search->frame.constants, strengths) +
           search->strengths_left[k] + rarity + log(colour);
}
