/* How long something else than before is left out: until it has lasted for a
 * time, and until several frames in a row have shown it.  With frames that come
 * seldom, as with DECISION_MS, the time alone would let a single one count. */
#ifndef HOLD_H
#define HOLD_H

#include <stdbool.h>
#include <stdint.h>

/* Frames in a row, at least. */
#define HOLD_FRAMES 3

typedef struct {
    uint32_t since_ms; /* when a frame last was as before, or hold_begin */
    uint8_t others;    /* frames since then, HOLD_FRAMES at most */
} hold_t;

/* A frame is as before, or the wait begins anew. */
static inline void hold_begin(hold_t *hold, uint32_t now_ms)
{
    hold->since_ms = now_ms;
    hold->others = 0;
}

/* A frame is not as before.  Returns whether that has lasted for hold_ms and
 * for this many frames, 1 to HOLD_FRAMES. */
static inline bool hold_ends(hold_t *hold, uint32_t hold_ms, uint8_t frames,
                             uint32_t now_ms)
{
    if (hold->others < HOLD_FRAMES)
        hold->others++;
    return hold->others >= frames && now_ms - hold->since_ms >= hold_ms;
}

#endif
