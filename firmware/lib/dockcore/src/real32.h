/* IEEE 754 single precision without floating point: MAVLink's parameters and
 * command arguments travel so, the core computes in integers. */
#ifndef REAL32_H
#define REAL32_H

#include <stdbool.h>
#include <stdint.h>

/* The bits nearest to n / 2^shift, ties to even; shift 0..63. */
uint32_t real32_from_fixed(int64_t n, uint8_t shift);

/* value * 2^shift into *n, rounded to the nearest, ties away from zero.  False
 * for NaN, infinity, or where it is 2^53 or more. */
bool real32_to_fixed(uint32_t bits, uint8_t shift, int64_t *n);

#endif
