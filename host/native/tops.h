/* The tops of lamps' smoothed light: chromadock.robust's frame/refine.py says
 * what for.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef TOPS_H
#define TOPS_H

#include <stdint.h>

/* Steps: a lamp's top is looked for within this of where it was supposed; half
 * the diagonal of the plateau of a lamp that fills 2 x 2 cells. */
#define TOPS_FARTHEST 6

/* Widths of the smoothing at most. */
#define TOPS_WIDTHS 7

/* Places that a lamp is supposed in at most. */
#define TOPS_MOST 3

/* Height of another top near a small lamp, of the highest's, that may be the
 * lamp: a glint beside it or the edge of a strut may be the brighter one.
 * Which of them it is the whole dock tells. */
#define TOPS_OTHER 0.35

/* Widths at most that fit between the markers of small lamps: then a top is a
 * lamp, not a speck of one. */
#define TOPS_SMALL 2

/* Standard error in pixels that a sensor's colour mosaic leaves the sharpest
 * lamp: of red and of blue light it sees every fourth pixel. */
#define TOPS_SAMPLING 0.12

/* The share of it that is left to a blunt lamp.  Bend over height of a top at
 * the least width, in steps: of a lamp that falls between the mosaic's samples,
 * and of one spread over several. */
#define TOPS_LEAST_SAMPLING 0.4
#define TOPS_SHARP 0.37
#define TOPS_BLUNT 0.1

/* Standard error left to the brightest lamp, by the smoothing's width: what
 * stands behind it is not flat, and shifts the top. */
#define TOPS_FLOOR 0.02

/* Standard error of a place, in its top's way from one smoothing to the next
 * one half an octave narrower or wider, whichever is shorter.  The top of a
 * round lamp stays where it is; that of the corner of two bright bars, or of a
 * lamp that a bar draws aside, goes on with each width, and is off by two or
 * three such steps. */
#define TOPS_DRIFT 0.9

/* Steps from one such smoothing to the next: what moves by more is no lamp, but
 * light that stands beside something brighter, a bright thing's rim or a bar's
 * corner. Of 1,545 lamps found in drawn scenes of the half that was developed
 * on the 99th centile is 0.35, and the greatest 0.98. */
#define TOPS_MOST_DRIFT 1.0

/* Where a lamp may be: x, y in steps from the patch's middle;
 * sigma: standard deviation in x as in y, pixels, if it is a lamp and round;
 * drift: that of what may draw it aside, pixels. width: of the smoothing that
 * it is the top of, pixels; give: pixels by which a slope of that light of 1
 * per pixel moves it. */
typedef struct {
    double x, y, sigma, drift, width, give;
} tops_top_t;

/* One lamp's patch.
 *
 * smoothed: the light of side x side steps, smoothed by Gaussians of (count +
 * 2) widths, half an octave from each other, narrowest first; the surround of
 * a width is the smoothing of one two places on.
 * widths: count or more, in steps.  reach: steps from the patch's middle that
 * the lamp may be, TOPS_FARTHEST at most.
 * step: pixels.  noise: of the light's slope, for a width of 1, times step. */
typedef struct {
    int32_t count, side;
    const float *smoothed;
    const double *widths;
    double reach, step, noise;
} tops_patch_t;

/* The tops of a patch, the likeliest first: the best located one uphill of the
 * middle, then others about; none where that one is no lamp's.  tops: receives
 * as many as are returned, TOPS_MOST at most. */
int32_t tops_find(const tops_patch_t *patch, tops_top_t *tops);

/* Of the way from the brightest place half way to the next lamp up to an
 * overexposed lamp's own brightest: light above this is its core. */
#define TOPS_CORE_LEVEL 0.3

/* The centre of an overexposed lamp's core, found from x, y on, steps from the
 * middle of side x side steps of light: the centroid of the light within radius
 * of it that is above TOPS_CORE_LEVEL. Returns -1, and leaves x and y, where
 * nothing is: the lamp is one with its neighbour. */
int32_t tops_core(const float *light, int32_t side, double radius, double *x,
                  double *y);

#endif
