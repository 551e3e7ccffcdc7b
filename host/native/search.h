/* Constellations among the peaks of a frame, ranked by the evidence that they
 * are the dock.
 *
 * The evidence for a set of peaks is the natural logarithm of a likelihood
 * ratio: the density of such places, strengths and colours if the peaks are a
 * dock's markers, over their density if they are clutter.  Summed over all
 * sets of peaks of a Poisson clutter these ratios are expected to come to one
 * (Mecke's formula: Last and Penrose, Lectures on the Poisson Process, 2017,
 * chapter 4).  By Markov's inequality, therefore, a frame without a dock has a
 * set with a ratio of 1/e or more with a probability of at most e, however
 * many sets there are to choose from.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller.  Calls from several threads are independent. */
#ifndef SEARCH_H
#define SEARCH_H

#include "evidence.h"

/* More are refused; at most 70 kB of stack are used. */
enum { SEARCH_MAX_PROMISING = 64 };

/* As many fit into two vectors. */
enum { SEARCH_MAX_FACETS = 8 };

/* Where one marker is seen from another: its displacement d is at least
 * shortest and at most longest pixels long, and at an angle to the unit vector
 * (x, y) whose tangent is at most slope. */
typedef struct {
    double shortest, longest, x, y, slope;
} search_window_t;

/* A rectangle of complex numbers. */
typedef struct {
    double left, right, top, bottom;
} search_box_t;

/* The facets of a span side by side: log of the facet's share in the span,
 * times the density of b at its peak; and where the third marker is expected: w
 * is u + ux x, v + vx x + vy y for its b = x + iy.  Beyond the last facet
 * log_norm is minus infinity, and the others are 0. */
typedef struct {
    double log_norm[SEARCH_MAX_FACETS];
    double u[SEARCH_MAX_FACETS], v[SEARCH_MAX_FACETS];
    double ux[SEARCH_MAX_FACETS];
    double vx[SEARCH_MAX_FACETS], vy[SEARCH_MAX_FACETS];
} search_third_t;

/* What a dock of n markers looks like to one camera, for peaks of one scale.
 *
 * Its first two markers, p and q, are the base; the shape of the others is
 * b = (z - z_p) / (z_q - z_p), in complex numbers (Bookstein, Statistical
 * Science 1 (1986) 181): m = n - 2 of them.  Views are told apart by the
 * base's length into spans, and each of these by the side that is seen into
 * facets; in each of these classes the shape is normal.  Its covariance C is
 * given by the inverse W of its Cholesky factor L, C = L L', so that
 * w = offset + W b is standard normal, and the two components of it that a
 * marker adds depend on its own b and on those before it alone. */
typedef struct {
    int32_t markers;            /* n, 3 or more */
    int32_t spans, facets;      /* the latter SEARCH_MAX_FACETS at most */
    search_window_t base, side; /* of q, and of the third marker, from p */
    double slack;               /* pixels: what windows allow for errors */
    double roll_rad;            /* standard deviation of the base's direction */
    double log_spread;          /* log of the base's range of log lengths, times
                                 * roll_rad sqrt(2 pi) */
    double gate; /* w squared is less than this for each marker of a dock */
    const double *along;       /* n: places along the dock, -1..1 */
    const double *edges;       /* spans - 1 lengths between them, pixels */
    const double *most_norm;   /* spans: the largest log_norm of its facets */
    const double *offset;      /* spans x facets x 2m: minus W times the mean */
    const double *whiten;      /* spans x facets x 2m x 2m: W, lower triangular;
                                * Re b_3, Im b_3, Re b_4, ... */
    const search_box_t *boxes; /* spans: where b_3 passes some facet's gate */
    const search_third_t *thirds; /* spans */
} search_dock_t;

/* What a search takes from the peaks of one scale, whichever dock of so many
 * markers is looked for: computed once.  The caller gives room for
 * search_bounds_size() bytes, aligned as a double is; the frame must live as
 * long. */
typedef struct search_bounds search_bounds_t;

size_t search_bounds_size(void);

/* promising: promising_count (at most SEARCH_MAX_PROMISING) indices of peaks,
 * ascending; markers are looked for among them, all peaks are clutter.
 * Returns 0, or -1 if there are too many. */
int32_t search_prepare(search_bounds_t *bounds, const evidence_frame_t *frame,
                       int32_t markers, int32_t promising_count,
                       const int32_t *promising);

/* Find the sets of promising peaks with an evidence of least or more.
 *
 * bounds: prepared for as many markers as the dock has.
 * most_sets: the best so many, 1 or more, are kept.
 * most_weighed: after weighing so many sets, complete or not, the search gives
 * up, which bounds its time; it begins with the strongest peaks.
 * members: receives most_sets x n indices of peaks, those of p, q, the third...
 * evidence, looks: receive most_sets values each, the best set first: all of
 * the evidence, and the part of it that evidence_of_sets gives.
 * weighed: receives how many sets of three markers or more were weighed.
 * Returns the number of sets found, which all differ. */
int32_t search_find(const search_dock_t *dock, const search_bounds_t *bounds,
                    double least, int32_t most_sets, int32_t most_weighed,
                    int32_t *members, double *evidence, double *looks,
                    int32_t *weighed);

#endif
