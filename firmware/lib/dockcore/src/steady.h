/* The hue shown: the rolling mean of decisions of one kind.
 *
 * Water has a hue or it has none (grey, dark, a mixture), and near the limit
 * between them decisions of both kinds come in turns; the mean of a mapped hue
 * and the fallback would be neither.  So decisions of another kind are left out
 * of the mean until nothing else has come for a while; then the window is
 * emptied and they are shown. */
#ifndef STEADY_H
#define STEADY_H

#include <stdbool.h>
#include <stdint.h>

#include "hold.h"
#include "rolling.h"

typedef struct {
    rolling_t rolling;
    uint16_t shown;  /* before the first decision: what steady_show was given */
    bool meaningful; /* the kind of the decisions in the window */
    bool begun;      /* false: the next decision is taken as it is */
    hold_t hold;     /* of decisions that are not like those in the window */
} steady_t;

void steady_init(steady_t *steady);

/* Forgets the decisions in the window and shows `hue`, until the next one. */
void steady_show(steady_t *steady, uint16_t hue);

/* The next decision is taken whatever it is like. */
void steady_let_go(steady_t *steady);

/* Whether a decision that is `like` those in the window, or is not, is to be
 * taken: always where it is like them, or there was none yet; else where none
 * that is like them came for hold_ms, and this many that are not (hold.h).
 * Empties the window where it is not like what is in there. */
bool steady_takes(steady_t *steady, bool like, uint32_t hold_ms, uint8_t frames,
                  uint32_t now_ms);

/* The wait for decisions of another kind begins now. */
void steady_wait(steady_t *steady, uint32_t now_ms);

/* Takes a decision made at now_ms: the hue, and whether it is that of water
 * with a hue. */
void steady_take(steady_t *steady, bool meaningful, uint16_t hue,
                 uint32_t window_ms, uint32_t now_ms);

/* Both at once, as dock and vehicle agree: alike are decisions of one kind, and
 * another kind is taken after METHOD_HOLD_MS, of however many frames. */
void steady_add(steady_t *steady, bool meaningful, uint16_t hue,
                uint32_t window_ms, uint32_t now_ms);

#endif
