/* What a peak looks like, and how much more like a lamp than like clutter. */
#ifndef LOOKS_H
#define LOOKS_H

#include "summits.h"

enum { LOOKS_RINGS = 3, LOOKS_LARGEST_RING = 8 * LOOKS_RINGS };

/* Numbers that a cell of a ring is multiplied by, for as many sums: 1, the
 * cosine and sine of one turn, and those of two.  The others are 0, for vectors
 * are so wide. */
enum { LOOKS_WAVES = 8 };

/* The cells of one ring about a cell: how far in memory each is. */
typedef struct {
    int count;
    int off[LOOKS_LARGEST_RING];
    float waves[LOOKS_LARGEST_RING][LOOKS_WAVES];
} ring_t;

/* Fills in the rings of an image whose rows begin `stride` numbers from each
 * other. */
void looks_prepare(int stride, ring_t rings[LOOKS_RINGS]);

/* The looks of a summit whose top is at xy, in pixels of the frame. */
void looks_at(const front_frame_t *frame, const ring_t rings[LOOKS_RINGS],
              const summit_t *summit, const double xy[2], double flatness,
              double looks[FRONT_LOOKS]);

/* Whether a cell lacks light against its surround, and not because something
 * bright is in that: it is darker than most of what is about it. */
bool looks_dark(const front_frame_t *frame, int at);

/* Natural log of how much likelier such a peak is a lamp than clutter: the
 * ratio of the posterior odds with the looks to those without is the ratio of
 * the densities of the looks. */
double looks_likeness(const front_network_t *network, const double *looks,
                      double snr, int scale);

#endif
