/* Instructions counted with the emulator's clock, which advances with them. */
#ifndef INSTRUCTIONS_H
#define INSTRUCTIONS_H

#include <stdbool.h>
#include <stdint.h>

/* Measures the clock on blocks of known length.  False: it does not advance
 * evenly enough to count single instructions. */
bool instructions_calibrate(void);

/* Between two readings of the clock, the readings themselves not counted. */
uint32_t instructions_between(uint32_t start, uint32_t end);

#endif
