/* From camera frames to the marker's hue, with what was seen on the way.
 *
 * Only decision.c writes the fields; everybody may read them. */
#ifndef DECISION_H
#define DECISION_H

#include <stdbool.h>
#include <stdint.h>

#include "background.h"
#include "frame.h"
#include "settings.h"
#include "steady.h"

/* Water below this value is dim: there the dock's own lamps, or a vehicle's,
 * can be as bright as daylight. */
#define DECISION_DIM_VALUE 64

/* What a dock without a camera waits for a decision before it lights up, and
 * after which an old decision is none any more. */
#define DECISION_WAIT_MS 15000

/* At night, where the light changes slowly and frames that count may come every
 * ten seconds, the marker's hue is the mean over a minute. */
#define DECISION_NIGHT_WINDOW_MS 60000

/* Water to compare with: its value and its marker's hue. */
typedef struct {
    uint8_t value;
    uint16_t hue;
} decision_mark_t;

typedef struct {
    smoothed_t smoothed;     /* only while a frame is decided on */
    background_t background; /* of the last good frame */
    steady_t steady;      /* the marker's hues; .shown is what the LEDs show */
    uint16_t decided_hue; /* of the last good frame alone */
    uint16_t water_hue;   /* of the last frame that was taken */
    uint8_t water_value;
    decision_mark_t held;   /* dim water: what decisions must be like */
    uint32_t held_ms;       /* when that was seen */
    decision_mark_t other;  /* dim water unlike that, which waits to be taken */
    uint32_t sampled_ms;    /* dim water: when one last went into the mean */
    bool decided;           /* whether a frame was taken yet */
    bool refused;           /* whether the last frame was not valid */
    uint32_t frames;        /* decided on; stays at UINT32_MAX */
    uint32_t frame_faults;  /* frames refused; stays at UINT32_MAX */
    uint32_t last_frame_ms; /* when the last good frame came */
    uint32_t frame_period_q8; /* mean time between frames in units of 1/256 ms;
                                 0 before the second frame */
} decision_t;

/* Shows `hue` until the first decision. */
void decision_init(decision_t *decision, uint16_t hue);

/* Looks at a frame, wherever it comes from, and changes nothing that is shown.
 * Returns false for a frame that is not valid: it is counted. */
bool decision_see(decision_t *decision, const frame_t *frame,
                  const dock_settings_t *settings, uint32_t now_ms);

/* Takes what decision_see saw into what is shown, averaged over window_ms.
 * Returns false where it waits: decisions of another kind for METHOD_HOLD_MS,
 * and for the third one in a row.
 *
 * Dusk and dawn are slow, and a vehicle's lamps pass: in dim water all that is
 * unlike what was ten seconds before waits, for half a minute in which it must
 * not change; and the mean is that of DECISION_NIGHT_WINDOW_MS. */
bool decision_take(decision_t *decision, uint32_t window_ms, uint32_t now_ms);

/* Takes that nothing could be seen: water without a hue. */
void decision_take_none(decision_t *decision, const dock_settings_t *settings,
                        uint32_t window_ms, uint32_t now_ms);

/* Sees and takes a frame whatever was before it, but for the rolling mean: one
 * that a host injects. */
bool decision_frame(decision_t *decision, const frame_t *frame,
                    const dock_settings_t *settings, uint32_t now_ms);

/* Notes that a frame was refused before it came. */
void decision_refuse(decision_t *decision);

/* Forgets the decisions of the window, and goes on showing their mean. */
void decision_forget(decision_t *decision);

/* Shows what the settings have for the water last seen, where they changed in
 * that; no hue in between. */
void decision_follow(decision_t *decision, const dock_settings_t *before,
                     const dock_settings_t *now);

/* Whether the water was dim when a frame was last taken. */
bool decision_is_dim(const decision_t *decision);

/* Whether good frames have stopped coming: none for DECISION_WAIT_MS. */
bool decision_is_stale(const decision_t *decision, uint32_t now_ms);

/* Frames a second, times ten; 0 before the second frame and where they have
 * stopped coming. */
uint16_t decision_rate_dhz(const decision_t *decision, uint32_t now_ms);

#endif
