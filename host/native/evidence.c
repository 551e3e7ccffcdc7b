#include "evidence.h"

#include "internal/vectors.h"
#include "internal/weighing.h"

#include <math.h>
#include <stddef.h>

/* What is known of a peak by itself. */
static void describe(peak_t *peak, const evidence_frame_t *frame,
                     const evidence_peaks_t *peaks, int32_t i)
{
    const evidence_constants_t *constants = frame->constants;
    double noise = 1 / peaks->snr[i];
    peak->x = peaks->places[2 * i];
    peak->y = peaks->places[2 * i + 1];
    peak->likeness = peaks->likeness[i];
    peak->ratio = exp(peak->likeness);
    peak->log_snr = log(peaks->snr[i]);
    peak->weight = 1 / (square(constants->strength_spread) + square(noise));
    peak->log_density = 0.5 * log(peak->weight / (2 * PI));
    peak->height = larger(peak->log_snr - log(peaks->least_snr), 0);
    peak->around_area = PI * frame->near_square * peaks->inside[i];
    peak->chroma_x = peaks->chroma[2 * i];
    peak->chroma_y = peaks->chroma[2 * i + 1];
    peak->variance = square(constants->colour_spread) +
                     square(constants->colour_noise * noise);
    peak->supposed = student(square(peak->chroma_x) + square(peak->chroma_y),
                             square(constants->colour_wide) + peak->variance);
}

/* Numbers of all peaks side by side, for vector instructions. */
typedef struct {
    double x[EVIDENCE_MAX_PEAKS], y[EVIDENCE_MAX_PEAKS];
    double chroma_x[EVIDENCE_MAX_PEAKS], chroma_y[EVIDENCE_MAX_PEAKS];
    double variance[EVIDENCE_MAX_PEAKS];
    double everywhere[EVIDENCE_MAX_PEAKS], nearby[EVIDENCE_MAX_PEAKS];
    int64_t around[EVIDENCE_MAX_PEAKS];
} columns_t;

/* Compares the i-th peak with those before it. */
static inline void compare(columns_t *restrict all, int32_t i,
                           double near_square, peak_t *peak)
{
    const double x = all->x[i], y = all->y[i], variance = all->variance[i];
    const double chroma_x = all->chroma_x[i], chroma_y = all->chroma_y[i];
    double same[EVIDENCE_MAX_PEAKS], same_nearby[EVIDENCE_MAX_PEAKS];
    int64_t stronger = 0;
    for (int32_t j = 0; j < i; j++) {
        const double apart = square(chroma_x - all->chroma_x[j]) +
                             square(chroma_y - all->chroma_y[j]);
        const bool is_near =
            square(x - all->x[j]) + square(y - all->y[j]) < near_square;
        same[j] = student(apart, variance + all->variance[j]);
        same_nearby[j] = is_near ? same[j] : 0;
        all->everywhere[j] += same[j];
        all->nearby[j] += same_nearby[j];
        all->around[j] += is_near;
        stronger += is_near;
    }
    double everywhere = student(0, 2 * variance), nearby = everywhere;
    for (int32_t j = 0; j < i; j++) {
        everywhere += same[j];
        nearby += same_nearby[j];
    }
    all->everywhere[i] = everywhere;
    all->nearby[i] = nearby;
    all->around[i] = 1 + stronger;
    peak->stronger = (int32_t)stronger;
}

size_t evidence_frame_size(void)
{
    return sizeof(evidence_frame_t);
}

WIDE_VECTORS int32_t evidence_prepare(evidence_frame_t *frame,
                                      const evidence_constants_t *constants,
                                      const evidence_peaks_t *peaks)
{
    columns_t all;
    if (peaks->count > EVIDENCE_MAX_PEAKS)
        return -1;
    frame->constants = constants;
    frame->count = peaks->count;
    frame->area = peaks->area;
    frame->near_square = square(constants->clutter_neighbourhood) * peaks->area;
    frame->heights = frame->ratios = 0;
    for (int32_t i = 0; i < peaks->count; i++) {
        peak_t *peak = &frame->peaks[i];
        describe(peak, frame, peaks, i);
        frame->heights += peak->height;
        frame->ratios += peak->ratio;
        all.x[i] = peak->x;
        all.y[i] = peak->y;
        all.chroma_x[i] = peak->chroma_x;
        all.chroma_y[i] = peak->chroma_y;
        all.variance[i] = peak->variance;
        compare(&all, i, frame->near_square, peak);
    }
    for (int32_t i = 0; i < peaks->count; i++) {
        frame->peaks[i].everywhere = all.everywhere[i];
        frame->peaks[i].nearby = all.nearby[i];
        frame->peaks[i].around = (int32_t)all.around[i];
    }
    return 0;
}

double evidence_log_alike(const evidence_constants_t *constants,
                          const strengths_t *s)
{
    double utt = s->utt + 1 / square(constants->strength_slope);
    double determinant = s->u * utt - s->ut * s->ut;
    double explained = (utt * s->uv * s->uv - 2 * s->ut * s->uv * s->uvt +
                        s->u * s->uvt * s->uvt) /
                       determinant;
    double scale = constants->strength_slope * constants->strength_log_range;
    return s->log_density - 0.5 * (s->uvv - explained) -
           0.5 * log(determinant * square(scale) / (2 * PI));
}

double evidence_rarity(const evidence_frame_t *frame, const peak_t *peak,
                       int32_t stronger, int32_t nearby, int32_t count,
                       double total, double strongest)
{
    const evidence_constants_t *constants = frame->constants;
    double height = peak->height;
    double a = constants->clutter_supposed + (count > 0 ? count : 0);
    double b =
        constants->clutter_supposed / constants->clutter_exponent + total;
    double expected = stronger + 1;
    if (stronger == 0) {
        double fall = pow((b + strongest) / (b + height), a);
        expected = larger(fall < 1 ? fall : 1, constants->clutter_most_fall);
    }
    double density =
        (nearby + 1) / (peak->around_area + frame->area / expected);
    return -log(a / (b + height) * density);
}

double evidence_clutter_colour(const evidence_frame_t *frame,
                               const peak_t *peak, double everywhere,
                               int32_t count, double nearby, int32_t around)
{
    double supposed = frame->constants->colour_supposed;
    double overall = (larger(everywhere, 0) + supposed * peak->supposed) /
                     (count + supposed);
    return (larger(nearby, 0) + supposed * overall) / (around + supposed);
}

/* Sum of the rarities of a set, whose members are no clutter. */
static double set_rarity(const evidence_frame_t *frame, int32_t size,
                         const int32_t *members)
{
    int32_t stronger[EVIDENCE_MAX_PEAKS], nearby[EVIDENCE_MAX_PEAKS], first = 0;
    double total = frame->heights, sum = 0;
    for (int32_t i = 0; i < size; i++) {
        const peak_t *peak = &frame->peaks[members[i]];
        stronger[i] = members[i];
        nearby[i] = peak->stronger;
        for (int32_t j = 0; j < size; j++)
            if (members[j] < members[i]) {
                stronger[i]--;
                nearby[i] -= are_near(frame, peak, &frame->peaks[members[j]]);
            }
        total -= peak->height;
        first += stronger[i] == 0;
    }
    /* The strongest of the others comes after those members that none of them
     * is stronger than. */
    double strongest = first < frame->count ? frame->peaks[first].height : 0;
    for (int32_t i = 0; i < size; i++)
        sum +=
            evidence_rarity(frame, &frame->peaks[members[i]], stronger[i],
                            nearby[i], frame->count - size, total, strongest);
    return sum;
}

/* Log likelihood ratio that a set has one colour in common: of the mean of the
 * ratios with each member for the one that has the dock's. */
static double set_colour(const evidence_frame_t *frame, int32_t size,
                         const int32_t *members)
{
    double clutter[EVIDENCE_MAX_PEAKS], sum = 0;
    for (int32_t j = 0; j < size; j++) {
        const peak_t *peak = &frame->peaks[members[j]];
        double everywhere = peak->everywhere, nearby = peak->nearby;
        int32_t around = peak->around;
        for (int32_t i = 0; i < size; i++) {
            const peak_t *other = &frame->peaks[members[i]];
            double same = same_colour(peak, other);
            everywhere -= same;
            if (are_near(frame, peak, other)) {
                nearby -= same;
                around--;
            }
        }
        clutter[j] = evidence_clutter_colour(
            frame, peak, everywhere, frame->count - size, nearby, around);
    }
    for (int32_t i = 0; i < size; i++) {
        double product = 1;
        for (int32_t j = 0; j < size; j++)
            if (j != i)
                product *= colour_ratio(frame->constants->colour_disturbed,
                                        same_colour(&frame->peaks[members[i]],
                                                    &frame->peaks[members[j]]),
                                        clutter[j]);
        sum += product;
    }
    return log(sum / size);
}

double evidence_log_mean_ratio(const evidence_frame_t *frame, int32_t count,
                               double ratios)
{
    double supposed = frame->constants->likeness_supposed;
    return log((supposed + larger(ratios, 0)) /
               (supposed + (count > 0 ? count : 0)));
}

double evidence_of_set(const evidence_frame_t *frame, int32_t size,
                       const int32_t *members, const double *along)
{
    strengths_t strengths = {0};
    double likeness = 0, ratios = frame->ratios;
    for (int32_t i = 0; i < size; i++) {
        const peak_t *peak = &frame->peaks[members[i]];
        ratios -= peak->ratio;
        add_strength(&strengths, peak->log_snr, peak->weight, peak->log_density,
                     along[i]);
        likeness += peak->likeness;
    }
    likeness -=
        size * evidence_log_mean_ratio(frame, frame->count - size, ratios);
    return evidence_log_alike(frame->constants, &strengths) + likeness +
           set_rarity(frame, size, members) + set_colour(frame, size, members);
}

int32_t evidence_of_sets(const evidence_frame_t *frame, int32_t sets,
                         int32_t size, const int32_t *members,
                         const double *along, double *evidence)
{
    if (size > frame->count)
        return -1;
    for (int32_t i = 0; i < sets; i++)
        evidence[i] =
            evidence_of_set(frame, size, members + (ptrdiff_t)i * size, along);
    return 0;
}
