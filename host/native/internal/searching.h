/* What the sources that search for sets of peaks share. */
#ifndef SEARCHING_H
#define SEARCHING_H

#include "../search.h"
#include "weighing.h"

/* More than what rounding does to a sum of logarithms. */
#define ROUNDING 1e-6

/* Peaks here are the promising ones, numbered from 0. */
struct search_bounds {
    const evidence_frame_t *frame;
    int32_t markers, count;
    int32_t promising[SEARCH_MAX_PROMISING];
    double place_x[SEARCH_MAX_PROMISING], place_y[SEARCH_MAX_PROMISING];
    /* Bounds, whatever the other members of a set are: of a peak's rarity and
     * likeness; of the sum of so many peaks'; of the ratio that one peak's
     * (first's) colour is the other's; and of the product of that (second's)
     * with so many (first) others. */
    double rarity[SEARCH_MAX_PROMISING], rarest[SEARCH_MAX_PROMISING + 1];
    double colour[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    double nearest_colours[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    /* Of the log ratio of a set's colours, if this peak has the dock's, and if
     * any has. */
    double log_colours[SEARCH_MAX_PROMISING], most_log_colours;
};

typedef struct {
    const search_bounds_t *bounds;
    const search_dock_t *dock;
    double least;
    double log_places; /* of the frame's places and of the base's turns */
    /* Of the log density of the strengths of all markers. */
    double strengths;
    /* And of what all markers but the first k add to the log density of the
     * strengths. */
    double strengths_left[SEARCH_MAX_PROMISING + 1];
    /* Of strengths and colours and of the rarity of all markers but three. */
    double beside;
    /* The set: the peaks taken for p, q, ..., and their b. */
    int32_t set[SEARCH_MAX_PROMISING];
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    /* Of all peaks: what b would be. */
    double every_x[SEARCH_MAX_PROMISING], every_y[SEARCH_MAX_PROMISING];
    int32_t weighed, most_weighed; /* sets, complete or not */
    /* What was found, the best first. */
    int32_t most_sets, found;
    int32_t *members;
    double *evidence, *looks;
} search_t;

static inline const peak_t *bounds_peak(const search_bounds_t *bounds,
                                        int32_t i)
{
    return &bounds->frame->peaks[bounds->promising[i]];
}

/* Fills in what a search bounds the strengths by, which has its dock. */
void bounds_of_strengths(search_t *search);

/* What bounds_looks() is at most, told by what is known of each of the first k
 * peaks alone. */
static inline double bounds_most_looks(const search_t *search, int32_t k)
{
    const search_bounds_t *bounds = search->bounds;
    double rarity = bounds->rarest[bounds->markers - k];
    double colour = bounds->log_colours[search->set[0]];
    for (int32_t i = 0; i < k; i++) {
        rarity += bounds->rarity[search->set[i]];
        colour = larger(colour, bounds->log_colours[search->set[i]]);
    }
    return search->strengths + rarity + colour + ROUNDING;
}

/* The same whichever the first k are, but for their rarity. */
double bounds_beside(const search_t *search, int32_t k);

/* What strengths, rarity and colours of a set may come to at most, whose first
 * k peaks are known: if the others are the rarest, and of the colour nearest
 * to that of the one that has the dock's. */
double bounds_looks(const search_t *search, int32_t k,
                    const strengths_t *strengths);

/* The same for a set whose next marker, after the first k, is peak i, told
 * without looking at that peak's colour and strength: looks is what
 * bounds_looks() says of the set without it. */
static inline double bounds_looks_with(const search_t *search, double looks,
                                       int32_t k, int32_t i)
{
    const search_bounds_t *bounds = search->bounds;
    const int32_t others = bounds->markers - k;
    return looks + bounds->rarity[i] + bounds->rarest[others - 1] -
           bounds->rarest[others] + ROUNDING;
}

#endif
