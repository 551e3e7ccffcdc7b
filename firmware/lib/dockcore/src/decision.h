/* From camera frames to the marker's hue, with what was seen on the way.
 *
 * Only decision.c writes the fields; everybody may read them. */
#ifndef DECISION_H
#define DECISION_H

#include <stdbool.h>
#include <stdint.h>

#include "background.h"
#include "frame.h"
#include "rolling.h"
#include "settings.h"

typedef struct {
    smoothed_t smoothed; /* only while a frame is decided on */
    background_t background;
    rolling_t rolling;
    uint16_t decided_hue;     /* of the last good frame alone */
    uint16_t marker_hue;      /* the rolling mean: what the LEDs show */
    bool decided;             /* whether there was a good frame yet */
    bool refused;             /* whether the last frame was not valid */
    uint32_t frames;          /* decided on; stays at UINT32_MAX */
    uint32_t frame_faults;    /* frames refused; stays at UINT32_MAX */
    uint32_t last_frame_ms;   /* when the last good frame came */
    uint32_t frame_period_q8; /* mean time between frames in units of 1/256 ms;
                                 0 before the second frame */
} decision_t;

void decision_init(decision_t *decision);

/* Decides on a frame, wherever it comes from.  Returns false for a frame that
 * is not valid: it is counted and changes no colour. */
bool decision_frame(decision_t *decision, const frame_t *frame,
                    const dock_settings_t *settings, uint32_t now_ms);

/* Notes that a frame was refused before it came. */
void decision_refuse(decision_t *decision);

/* Frames a second, times ten; 0 before the second frame. */
uint16_t decision_rate_dhz(const decision_t *decision);

#endif
