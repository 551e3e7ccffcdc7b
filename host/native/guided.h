/* Which peaks of a frame are a dock's markers, where its pose is known
 * beforehand: all of them, or all but one.
 *
 * The evidence for a set of peaks is the same likelihood ratio as in search.h,
 * with what is known of the pose in place of all views: the density of the
 * places, which are normal about the expected ones, and all that evidence.h
 * weighs.  One marker is taken for hidden where it has no peak, or where the
 * one that it has is unlikely to be it.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef GUIDED_H
#define GUIDED_H

#include "evidence.h"

/* How often a marker is out or behind something. */
#define GUIDED_HIDDEN 0.1

/* Chi-square with two degrees of freedom that true markers exceed in 0.1 %. */
#define GUIDED_GATE 13.8

/* The same that they exceed in 5 %: a marker so far from where the others have
 * it may be none. */
#define GUIDED_UNLIKELY 6.0

/* Where a dock of n markers is expected. */
typedef struct {
    int32_t markers;          /* n, from least_markers on */
    int32_t least_markers;    /* fewer are no dock */
    const double *along;      /* n: places along the dock, -1..1 */
    const double *places;     /* n x 2: x, y in pixels */
    const double *covariance; /* 2n x 2n: of the places */
    const uint8_t *inside;    /* n: 1 where that is in the picture; what shines
                               * nearest to another is what is left of its
                               * halo, and no marker's */
} guided_dock_t;

/* Peaks that are tried for each marker at most: bounds the time. */
enum { GUIDED_MOST_OPTIONS = 8 };

/* Find the likeliest set of peaks.
 *
 * frame: of peaks at places in pixels, each known to sigma_px in x as in y.
 * options: the nearest so many are tried for each marker, GUIDED_MOST_OPTIONS
 * at most. room: for 4 n^2 numbers. members: receives n indices of peaks, -1
 * for a hidden marker. evidence: receives that of the set, and -infinity if
 * there is none. Returns 0, or -1 if there are too many options. */
int32_t guided_guess(const guided_dock_t *dock, const evidence_frame_t *frame,
                     double sigma_px, int32_t options, double *room,
                     int32_t *members, double *evidence);

#endif
