/* Looks at the dark: which frames the dock's own lamps have not lit.
 *
 * A camera that sees the lamps' light makes the dock follow itself.  So the
 * lamps go out for a frame now and then, and that frame is compared with those
 * before: where they say the same, all frames decide; where they do not, only
 * such frames do.  Then the lamps are out for 2 % of the time, else for one
 * frame a minute.
 *
 * Only look.c writes the fields; everybody may read them. */
#ifndef LOOK_H
#define LOOK_H

#include <stdbool.h>
#include <stdint.h>

#include "decision.h"
#include "settings.h"

/* The lamps are never out for longer; 0.2 s with the time that a board needs
 * from one call of look_turn to the next. */
#define LOOK_LONGEST_MS 190

typedef enum {
    LOOK_UNLIT, /* the lamps have not been lit since the start */
    LOOK_LIT,
    LOOK_DARK, /* they are out for a look */
} look_state_t;

/* What a frame by itself decides. */
typedef struct {
    bool known, meaningful;
    uint8_t value; /* of the water */
    uint16_t hue;  /* of the marker */
} look_seen_t;

typedef struct {
    look_state_t state;
    uint32_t since_ms; /* the state's first moment, or a day ago if that is
                          later */
    uint32_t dark_ms;  /* how long the last look took */
    uint32_t pause_ms; /* from the end of a look to the next */
    bool due;          /* the lamps go out at the next turn */
    bool failed;       /* the last look ended without its frame */
    bool clear;        /* frames in the lamps' light decide too */
    look_seen_t dark;  /* the last frame without the lamps' light */
    look_seen_t lit;   /* the last frame in the lamps' light */
    hold_t odd;        /* of frames that look like the lamps, or unlike the
                          water before */
} look_t;

void look_init(look_t *look);

/* How the lamps are driven now. */
typedef struct {
    bool lit;     /* they show something, but for looks */
    bool follows; /* and that is the water's marker: looks are wanted */
} look_lamps_t;

/* To be called before the lamps are driven, often: begins and ends looks. */
void look_turn(look_t *look, look_lamps_t lamps, uint32_t now_ms);

/* Whether the lamps are to be out. */
bool look_is_on(const look_t *look);

/* Whether the next frame is to be one without the lamps' light. */
bool look_waits(const look_t *look);

/* A camera frame that decision_see has seen.  None of its light was gathered
 * before light_from_ms, none after now_ms.  Takes it where it counts. */
void look_frame(look_t *look, decision_t *decision,
                const dock_settings_t *settings, bool follows,
                uint32_t light_from_ms, uint32_t now_ms);

#endif
