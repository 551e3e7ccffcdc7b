/* The robust detector's front end: from a picture to the peaks that look like
 * lamps.
 *
 * front_respond() makes linear light of the picture at several scales, matched
 * filters of how that fluctuates, and tells how much each cell shines in units
 * of its local noise.  front_find() tells which cells stand out, and how like a
 * lamp each of them looks.  With the opposite sense it tells which stand out
 * for the light that they take away, as a lamp's black holder does before
 * bright water.
 *
 * All arrays are the caller's; what a function needs for itself it allocates
 * and frees again.  Nothing is kept between calls, so any number of frames may
 * be worked on at once. */
#ifndef FRONT_H
#define FRONT_H

#include <stdint.h>

/* Hues that are looked for at once, evenly about the circle from the expected
 * one: every lamp is within 30 degrees of one of them, and a matched filter
 * loses little by that. */
#define FRONT_HUES 6

/* Cells about each scale that repeat its outermost ones. */
#define FRONT_BORDER 3

/* Scales of a frame at most: cells of 1 to 128 pixels, or of 2 to 256.
 *
 * The finest is looked at through the expected hue's filter alone.  It shows
 * far lamps that the others merge with their holder or with each other; six
 * filters there would cost more than all other scales together. */
#define FRONT_SCALES 8

/* Pixels: a frame has at least so many rows and columns, two surrounds. */
#define FRONT_MIN_SIDE 64

/* The surround is at least so many pixels wide: water changes little over it,
 * and no far marker fills it.  It is at least so many cells wide as well: a
 * lamp that fills a cell does not fill the surround. */
#define FRONT_SURROUND_PIXELS 32
#define FRONT_SURROUND_CELLS 4

/* Linear light of a cell, 0 to 1, from which on its channel may have been
 * clipped. */
#define FRONT_CLIPPED_LIGHT 0.8

/* Signal to noise that a hue other than the expected one counts less: the
 * largest of several normal variables exceeds one of them by about so much. */
#define FRONT_UNEXPECTED 0.4

/* The same of what is dark, which noise alone hardly has. */
#define FRONT_MIN_DARK_SNR 5.0

/* Least signal to noise of a peak at the two finest scales.  Below it noise
 * alone has so many peaks that no constellation could stand out.  At a coarser
 * scale it is as much more as the cells are wider: what fills them is near. */
#define FRONT_MIN_SNR 3.0

/* The strongest peaks of each scale that are kept, so that any frame takes
 * bounded time, and how many of these are searched for markers. */
#define FRONT_MAX_PEAKS 112
#define FRONT_MAX_PROMISING 48

/* Radius of the neighbourhood in which a peak's clutter is counted, of the
 * frame's mean side: large enough for a few peaks, small enough to tell a
 * surface's band from the water below. */
#define FRONT_NEIGHBOURHOOD 0.18

/* What is seen about a peak: its looks. Rings are the cells one, two and three
 * from it, in squares; all they say is the same for a picture that is turned by
 * a right angle or mirrored. */
enum {
    /* One less four times determinant over squared trace of the Hessian: 0 for
     * a round top, 1 on a ridge. */
    FRONT_FLATNESS,
    /* The least on the way to the higher peak that is joined best, over the
     * peak; 0 if there is no higher one nearby. */
    FRONT_SADDLE,
    /* Light that is taken away in some channel, of all that is changed. */
    FRONT_MISSING,
    /* Of each ring, over the peak: the mean, the standard deviation, and how
     * much it varies once about the peak (a slope) and twice (a ridge): the
     * sizes of its first two Fourier coefficients. */
    FRONT_RINGS,
    /* At the next coarser scale, over the peak: the cell there, and the most of
     * it and the eight about it; then the cell at the scale after that, and the
     * most of nine cells at the next finer scale. -1 where there is no such
     * scale. */
    FRONT_COARSER = FRONT_RINGS + 12,
    FRONT_COARSER_MOST,
    FRONT_COARSEST,
    FRONT_FINER_MOST,
    /* By how much a channel's light rises above the first ring, of what the
     * channel that adds or takes away most does, that one first: a lamp's
     * channels rise together, or do nothing. */
    FRONT_CHANNELS,
    FRONT_LOOKS = FRONT_CHANNELS + 3
};

/* A lamp that outshines the noise by more looks the same. */
#define FRONT_MOST_SNR 60.0

/* What the looks are weighed by is a network of one hidden layer, of
 * FRONT_HIDDEN sums of FRONT_INPUTS numbers and 1, each through x / (1 + |x|);
 * what comes out of it is a sum of these, of the inputs and 1. The inputs are
 * the looks, and strength and scale; these, and 1, are the FRONT_BASE columns
 * of a regression that does without looks. */
#define FRONT_INPUTS 27
#define FRONT_HIDDEN 16
#define FRONT_BASE 6

/* Share of lamps that look as clutter does, and of clutter that looks as lamps
 * do, beyond what the network knows of both: there are docks, and things in the
 * water, of kinds that it was not fitted to. */
#define FRONT_STRANGE 0.02

/* hidden: those of each input for all sums, then those of 1. */
typedef struct {
    float hidden[FRONT_INPUTS + 1][FRONT_HIDDEN];
    float of_hidden[FRONT_HIDDEN];
    float of_inputs[FRONT_INPUTS + 1];
    float without[FRONT_BASE];
} front_network_t;

/* How one image holds a frame at all scales, the finest first, below each
 * other. About each scale is a border, so that what is around a cell is at the
 * same distances in memory wherever the cell is. */
typedef struct {
    int rows, columns;        /* of the image */
    int scales;               /* 2 to FRONT_SCALES */
    int cell[FRONT_SCALES];   /* pixels that a cell is wide */
    int top[FRONT_SCALES];    /* row of the first cell */
    int height[FRONT_SCALES]; /* rows without the border */
    int width[FRONT_SCALES];  /* columns without the border */
} front_layout_t;

/* What is known of a frame.  Images have layout.rows x layout.columns cells;
 * those of three channels are three of them one after the other, blue, green
 * and red.  Light is linear, 0 to 1.  The border of light and snr repeats the
 * outermost cells; that of added and best is not set, nor is what lies beside
 * the border of a scale that is narrower than the finest. */
typedef struct {
    front_layout_t layout;
    float *light;    /* 3 images: the mean light of each cell */
    float *added;    /* 3 images: the same less the light of the surround */
    float *snr;      /* the largest answer of a filter, in units of noise */
    uint8_t *best;   /* which filter gave it, 0 to FRONT_HUES - 1 */
    float *opposite; /* the largest of what answers are less than nothing, at
                      * all scales but the finest; no hue counts less here */
    double
        *covariance; /* 3 x 3: of the fluctuation of the second scale's cells */
    float *weights;  /* FRONT_HUES x 3: the matched filters, such that those
                      * cells fluctuate by about 1; first the expected hue's */
    double *axes;    /* 3 x 3: the matched filter of white, and two filters that
                      * are blind to white, such that all three fluctuate by 1,
                      * each for itself */
    int32_t sense;   /* 1; the same frame with -1 is seen for what takes light
                      * away, with snr and opposite interchanged: the sign of what
                      * is looked for in light and added */
} front_frame_t;

/* Peaks, those of each scale from FRONT_MAX_PEAKS times the scale on, the
 * strongest first.  Arrays have FRONT_MAX_PEAKS places for each scale. */
typedef struct {
    int count[FRONT_SCALES];
    double *xy;         /* x and y: pixels of the frame */
    double *snr;        /* signal to noise of the brightest 2 x 2 cells */
    double *noise;      /* standard deviation of the filtered light of a cell */
    double *chroma;     /* two angles off white, radians */
    double *looks;      /* FRONT_LOOKS for each peak */
    double *likeness;   /* log likelihood ratio of a lamp to clutter */
    double *inside;     /* share of the square about it, as wide as the
                         * neighbourhood, that lies inside the frame */
    uint8_t *promising; /* 1 if the peak is to be searched for markers */
} front_peaks_t;

/* Fills in all of a frame but its layout.  Returns 0, or -1 if there is no
 * memory.
 *
 * bgr: the picture, 3 bytes a pixel, row by row without gaps.
 * pixels: how many rows and columns of it make up a finest cell, 1 or 2.
 * linear: the linear light of each of the 256 values of a byte.
 * signatures: FRONT_HUES x 3, the light of lamps of each hue, the expected
 * first.
 * unexpected: signal to noise that other hues count less: FRONT_UNEXPECTED, or
 * 0 where none is expected before the others. */
int front_respond(front_frame_t *frame, const uint8_t *bgr, int pixels,
                  const float *linear, const double *signatures,
                  float unexpected);

/* Marks with 1 which cells of a scale of such a frame have a signal to noise of
 * FRONT_MIN_SNR or more, and the others with 0, row by row without the border.
 * Returns how many have. */
int front_standing_out(const front_frame_t *frame, int scale, uint8_t *cells);

/* Finds the peaks of a frame that front_respond() has filled in. */
void front_find(const front_frame_t *frame, const front_network_t *network,
                front_peaks_t *peaks);

/* Two angles each, in radians, by which n lights are off white, where the
 * frame's noise is the same in all colours.  added: 3 numbers for each, blue
 * first. */
void front_chroma(const front_frame_t *frame, const double *added, int n,
                  double *chroma);

/* The network's FRONT_INPUTS inputs, of which the last FRONT_BASE - 1 tell
 * strength and scale alone.  looks: FRONT_LOOKS numbers. */
void front_inputs(const double *looks, double snr, int scale, float *inputs);

#endif
