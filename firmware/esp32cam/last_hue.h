/* The hue that the dock shows, kept over a reset in memory that only power-on
 * clears. */
#ifndef LAST_HUE_H
#define LAST_HUE_H

#include <stdint.h>

void last_hue_keep(uint16_t hue);

/* The one kept; UINT16_MAX after power-on. */
uint16_t last_hue();

#endif
