/* Circular arithmetic on hues: unit vectors and the angle of a sum of them. */
#ifndef HUE_H
#define HUE_H

#include <stdbool.h>
#include <stdint.h>

#include "method.h"

/* A sum of hue vectors, in METHOD_TRIG_UNIT. */
typedef struct {
    int32_t x, y;
} hue_vector_t;

static inline int32_t hue_cos(uint32_t hue)
{
    return METHOD_SINE[hue + METHOD_HUE_RANGE / 4];
}

static inline int32_t hue_sin(uint32_t hue)
{
    return METHOD_SINE[hue];
}

/* From one hue to the other on the shorter way, 0..METHOD_HUE_RANGE / 2. */
uint32_t hue_distance(uint32_t a, uint32_t b);

/* The hue of a vector into *hue.  False, *hue untouched, for the zero vector:
 * it has none. */
bool hue_of_vector(hue_vector_t vector, uint16_t *hue);

#endif
