/* What the sources that weigh sets of peaks share. */
#ifndef WEIGHING_H
#define WEIGHING_H

#include <stdbool.h>

#include "../evidence.h"

static const double PI = 3.14159265358979323846;

/* A peak, and what depends on it alone or on it and all others. */
typedef struct {
    double x, y;
    double likeness, ratio; /* and its exponential */
    double log_snr, weight; /* of the log strength, one over its variance */
    double log_density;     /* of the log strength, at its mean */
    double height;          /* log of the strength over the least known */
    double around_area;     /* of its neighbourhood, as far as it is in view */
    double chroma_x, chroma_y, variance;
    double supposed; /* density of its chroma if nothing is known */
    /* Sums of the density of its chroma if its colour is another's, and how
     * many those nearby are: all with itself. */
    double everywhere, nearby;
    int32_t around;
    int32_t stronger; /* how many of those nearby are stronger */
} peak_t;

struct evidence_frame {
    const evidence_constants_t *constants;
    int32_t count;
    double area, near_square;
    double heights, ratios; /* sums of all */
    peak_t peaks[EVIDENCE_MAX_PEAKS];
};

static inline double square(double x)
{
    return x * x;
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

/* Density of Student's distribution in the plane with two degrees of freedom,
 * at a squared distance: noise's middle and glints' tails. */
static inline double student(double distance_square, double variance)
{
    return variance / (2 * PI * square(variance + 0.5 * distance_square));
}

/* Density of the chroma of one peak if its colour is the other's. */
static inline double same_colour(const peak_t *one, const peak_t *other)
{
    double apart = square(one->chroma_x - other->chroma_x) +
                   square(one->chroma_y - other->chroma_y);
    return student(apart, one->variance + other->variance);
}

/* Likelihood ratio that a peak has a marker's colour, which makes its chroma
 * so dense, where clutter's is so dense; disturbed: how often a marker's colour
 * is not the dock's. */
static inline double colour_ratio(double disturbed, double same, double clutter)
{
    return (1 - disturbed) * same / clutter + disturbed;
}

static inline bool are_near(const evidence_frame_t *frame, const peak_t *one,
                            const peak_t *other)
{
    return square(one->x - other->x) + square(one->y - other->y) <
           frame->near_square;
}

/* Sums over the members of a set for the regression of their log strengths v
 * on their places along the dock t, value = common + slope t: with weights u
 * they are of u, u t, u t^2, u v, u v t, u v^2, and of the log densities. */
typedef struct {
    double u, ut, utt, uv, uvt, uvv, log_density;
} strengths_t;

static inline void add_strength(strengths_t *sums, double value, double weight,
                                double log_density, double along)
{
    sums->u += weight;
    sums->ut += weight * along;
    sums->utt += weight * along * along;
    sums->uv += weight * value;
    sums->uvt += weight * value * along;
    sums->uvv += weight * value * value;
    sums->log_density += log_density;
}

/* Log density of the log strengths of markers: the integral over the common
 * value, which is evenly spread, and the slope, which is normal, of the product
 * of normal densities about them. */
double evidence_log_alike(const evidence_constants_t *constants,
                          const strengths_t *s);

/* Minus the log density of clutter, a square pixel and unit of log strength,
 * at a peak of some height that `stronger` and `nearby` others exceed, all
 * over and nearby, among `count` others whose heights add up to `total` and
 * are `strongest` at most.
 *
 * Heights are taken to be exponential, with an exponent whose gamma
 * distribution was updated by those of the others: then the share beyond a
 * height y is (b / (b + y))^a (Lomax, J. Am. Stat. Assoc. 49 (1954) 847), and
 * the density there is a / (b + y) times the number beyond it.  That number is
 * the local count, together with one more peak in as much area as holds one
 * stronger peak in all the frame: the mean of a gamma distribution after that
 * count.  What outshines all others is the rarer for it, to a limit. */
double evidence_rarity(const evidence_frame_t *frame, const peak_t *peak,
                       int32_t stronger, int32_t nearby, int32_t count,
                       double total, double strongest);

/* Density of clutter's chroma at a peak: the mean of the densities about the
 * others nearby (Parzen, Ann. Math. Statist. 33 (1962) 1065), as of rocks or
 * of a wall; as far as there are few, about those everywhere; and where these
 * are few, what is supposed. */
double evidence_clutter_colour(const evidence_frame_t *frame,
                               const peak_t *peak, double everywhere,
                               int32_t count, double nearby, int32_t around);

/* Log of the mean likelihood ratio of the clutter's looks, where `count` peaks'
 * add up to `ratios`.  Over clutter of all kinds that mean is 1; where the
 * frame's own looks like lamps, a lamp's looks say so much less. */
double evidence_log_mean_ratio(const evidence_frame_t *frame, int32_t count,
                               double ratios);

/* The evidence of one set in all but its places: see evidence_of_sets(). */
double evidence_of_set(const evidence_frame_t *frame, int32_t size,
                       const int32_t *members, const double *along);

#endif
