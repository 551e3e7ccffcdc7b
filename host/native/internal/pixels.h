/* What the sources that look at pixels themselves share. */
#ifndef PIXELS_H
#define PIXELS_H

#include <math.h>
#include <stdint.h>

/* Variance of linear light that 8 bits leave in dark water:
 * (2.2 * 0.05^1.2 / 255)^2 / 12. */
#define QUANTUM 5e-9

/* The row or column nearest to a place, of so many. */
static inline int32_t within(double value, int32_t size)
{
    return (int32_t)fmin(fmax(value, 0), size - 1);
}

#endif
