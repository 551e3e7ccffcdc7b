/* The golden vectors against dockcore, value by value. */
#ifndef VECTORS_H
#define VECTORS_H

#include "golden.h"

void check_frames(void);
void check_rolling(void);
void check_steady(void);
void check_leds(void);
void check_mappings(void);

/* What the dock is given to reproduce a golden frame. */
frame_t golden_frame(const golden_frame_t *golden);
dock_settings_t golden_settings(const golden_frame_t *golden);

#endif
