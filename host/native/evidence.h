/* The evidence that a set of peaks is a dock's markers, but for their places.
 *
 * It is the natural logarithm of a likelihood ratio: the density of such
 * strengths, looks and colours if the peaks are a dock's markers, over the
 * density of such peaks if they are clutter. See search.h for what it is worth.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef EVIDENCE_H
#define EVIDENCE_H

#include <stddef.h>
#include <stdint.h>

/* A frame with more is refused. */
enum { EVIDENCE_MAX_PEAKS = 128 };

/* What is supposed of markers' and of clutter's light.  The values, with the
 * reasons for them, stand in chromadock.robust: evidence, chroma, clutter. */
typedef struct {
    /* Standard deviations of the log strengths of a dock's markers about a
     * common value, and of their change from the dock's middle to its end; the
     * range that the common value's logarithm is evenly spread over. */
    double strength_spread, strength_slope, strength_log_range;
    /* Standard deviations of the chroma of a dock's markers, radians: always,
     * and at a signal to noise of 1; how often a marker's colour is not the
     * dock's. */
    double colour_spread, colour_noise, colour_disturbed;
    /* What is supposed of clutter's chroma before any peak is seen: worth so
     * many peaks, with this standard deviation about zero. */
    double colour_supposed, colour_wide;
    /* What is supposed of the tail of clutter's strengths: the number of peaks
     * above a strength falls as this power of it; worth so many peaks. */
    double clutter_exponent, clutter_supposed;
    /* The least factor by which a peak is rarer for outshining all clutter. */
    double clutter_most_fall;
    /* What is supposed of the mean likelihood ratio that clutter's looks give,
     * before any peak is seen: 1, worth so many peaks. */
    double likeness_supposed;
    /* Radius of a peak's neighbourhood, as a share of the frame's side. */
    double clutter_neighbourhood;
} evidence_constants_t;

/* Peaks of one frame at one scale, the strongest first. */
typedef struct {
    int32_t count;        /* 0..EVIDENCE_MAX_PEAKS */
    const double *places; /* count x 2: x, y in pixels */
    const double *snr;    /* count: signal to noise, above 0 */
    const double *chroma; /* count x 2: radians */
    const double
        *likeness;        /* count: log ratio of a lamp's looks to clutter's */
    const double *inside; /* count: share of each peak's neighbourhood that lies
                           * inside the frame */
    double least_snr;     /* from which on all of the frame's peaks are here */
    double area;          /* of the frame, square pixels */
} evidence_peaks_t;

/* What the evidence takes from the peaks of one frame at one scale, whichever
 * of them are taken for markers: computed once.  The caller gives room for
 * evidence_frame_size() bytes, aligned as a double is; the constants must live
 * as long. */
typedef struct evidence_frame evidence_frame_t;

size_t evidence_frame_size(void);

/* Returns 0, or -1 if there are too many peaks. */
int32_t evidence_prepare(evidence_frame_t *frame,
                         const evidence_constants_t *constants,
                         const evidence_peaks_t *peaks);

/* The evidence of given sets in all but their places.
 *
 * members: sets x size indices of peaks, those of a set all different.
 * along: size places along the dock, -1..1, of the markers at the members.
 * evidence: receives one value a set: log density of the strengths, sum of the
 * members' likeness, each over the mean of the clutter in this frame, log
 * likelihood ratio of their colours, and minus the log density of as many peaks
 * of clutter, in square pixels to the power of size. Returns 0, or -1 if a
 * set has more members than the frame has peaks. */
int32_t evidence_of_sets(const evidence_frame_t *frame, int32_t sets,
                         int32_t size, const int32_t *members,
                         const double *along, double *evidence);

#endif
