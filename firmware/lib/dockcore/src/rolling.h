/* Circular mean of the hues decided within a time window. */
#ifndef ROLLING_H
#define ROLLING_H

#include <stdint.h>

#include "method.h"

typedef struct {
    uint32_t time_ms[METHOD_WINDOW_CAPACITY]; /* a ring: oldest at `first` */
    uint16_t hue[METHOD_WINDOW_CAPACITY];
    uint8_t first, count;
} rolling_t;

void rolling_init(rolling_t *rolling);

/* Takes a hue decided at now_ms and returns the mean of all hues less than
 * window_ms old.  The clock may wrap at 2^32; decisions that lie in its future
 * (it was set back) are dropped.  Hues that cancel out leave the newest. */
uint16_t rolling_add(rolling_t *rolling, uint16_t hue, uint32_t now_ms,
                     uint32_t window_ms);

#endif
