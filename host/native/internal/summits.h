/* Cells that stand out, before it is known what they look like. */
#ifndef SUMMITS_H
#define SUMMITS_H

#include "cells.h"

/* Peaks that are looked at closely, of all scales. */
#define MAX_SUMMITS (3 * FRONT_MAX_PEAKS)

/* A cell that stands out and is no lower than those about it. */
typedef struct {
    int at, scale, row, column;
    float strength; /* signal to noise of the brightest 2 x 2 cells with it */
    float centre;   /* its own signal to noise */
    float saddle;   /* see FRONT_SADDLE */
} summit_t;

/* Eight directions, those opposite four apart: to the right, then clockwise. */
static const int DOWN[8] = {0, 1, 1, 1, 0, -1, -1, -1};
static const int ACROSS[8] = {1, 1, 0, -1, -1, -1, 0, 1};

/* Values some cells off in the eight directions. */
static inline void look_around(const float *cell, int stride, int radius,
                               float around[8])
{
    for (int i = 0; i < 8; i++)
        around[i] = cell[radius * (DOWN[i] * stride + ACROSS[i])];
}

/* Finds the strongest summits, scale by scale, row by row, and how they are
 * joined; returns how many there are. */
int summits_find(const front_frame_t *frame, summit_t summits[2 * MAX_SUMMITS]);

#endif
