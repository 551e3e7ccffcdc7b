/* One setting as a ground station knows it: a name and a number. */
#ifndef PARAMETER_H
#define PARAMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "settings.h"

typedef struct {
    const char *name; /* at most 15 letters */
    uint8_t offset;   /* in dock_settings_t */
    uint8_t size;     /* bytes there: 1, 2 or 4; signed where minimum < 0 */
    int32_t minimum, maximum, initial;
    uint8_t numerator, shift; /* shown = stored * numerator / 2^shift */
} parameter_t;

int32_t parameter_get(const parameter_t *parameter,
                      const dock_settings_t *settings);

/* False, nothing changed, for a value out of range. */
bool parameter_set(const parameter_t *parameter, dock_settings_t *settings,
                   int32_t stored);

/* MAVLink carries parameters as IEEE 754 single precision; these convert the
 * stored integer to its bits and back without floating point.  The second
 * rounds to the nearest stored value; false for what is no number or is out of
 * the range of 32 bits. */
uint32_t parameter_to_real32(const parameter_t *parameter, int32_t stored);
bool parameter_from_real32(const parameter_t *parameter, uint32_t bits,
                           int32_t *stored);

#endif
