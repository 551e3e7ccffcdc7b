/* What is known of a search under way, and bounds on what its sets may come to:
 * sets that cannot come to the least evidence are not completed. */
#ifndef SEARCHING_H
#define SEARCHING_H

#include "../search.h"
#include "weighing.h"

/* Peaks here are the promising ones, numbered from 0. */
typedef struct {
    frame_t frame;
    const search_dock_t *dock;
    double least;
    double log_places; /* of the frame's places and of the base's turns */
    int32_t count;
    const int32_t *promising;
    double place_x[SEARCH_MAX_PROMISING], place_y[SEARCH_MAX_PROMISING];
    /* Bounds, whatever the other members of a set are: of a peak's rarity and
     * likeness; of the sum of so many peaks'; of the ratio that one peak's
     * (second's) colour is the other's; and of the product of a peak's with so
     * many others. */
    double rarity[SEARCH_MAX_PROMISING], rarest[SEARCH_MAX_PROMISING + 1];
    double colour[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    double nearest_colours[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    /* And of what all markers but the first k add to the log density of the
     * strengths. */
    double strengths_left[SEARCH_MAX_PROMISING + 1];
    /* The set: the peaks taken for p, q, ..., their b, and of the base: its
     * displacement over its length squared. */
    int32_t set[SEARCH_MAX_PROMISING];
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    double base_x, base_y;
    int32_t weighed, most_weighed; /* sets, complete or not */
    /* What was found, the best first. */
    int32_t most_sets, found;
    int32_t *members;
    double *evidence, *looks;
} search_t;

static inline const peak_t *peak_at(const search_t *search, int32_t i)
{
    return &search->frame.peaks[search->promising[i]];
}

/* Fill in what bounds need, once the peaks, the dock and the promising ones are
 * known. */
void search_prepare_bounds(search_t *search);

/* What strengths, rarity and colours of a set may come to at most, whose first
 * k peaks are known: if the others are the rarest, and of the colour nearest
 * to that of the one that has the dock's. */
double search_hoped(const search_t *search, int32_t k,
                    const strengths_t *strengths);

/* The same for a set whose next marker, the k-th, is peak i, found without
 * looking at that peak's colour and strength: hoped is what search_hoped() says
 * of the set without it. */
static inline double search_hoped_with(const search_t *search, double hoped,
                                       int32_t k, int32_t i)
{
    int32_t others = search->dock->markers - k;
    return hoped + search->rarity[i] + search->rarest[others - 1] -
           search->rarest[others];
}

#endif
