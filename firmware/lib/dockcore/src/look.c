#include "look.h"

#include <string.h>

/* Of the time that a look took, lit between two of them: 2 % are dark. */
#define LIT_SHARE 49
#define FIRST_PAUSE_MS (LIT_SHARE * UINT32_C(200))
#define CLEAR_PAUSE_MS 60000
/* Markers of a dark frame and of a lit one, where the lamps change nothing. */
#define SAME_HUE (3 * METHOD_HUE_RANGE / 360)
/* The water's hue and that of the lamps, where it may be theirs. */
#define OWN_HUE (30 * METHOD_HUE_RANGE / 360)
/* So long in a row frames may be odd before they are doubted. */
#define DOUBT_MS 1000
/* A state that is older counts as this old, or its age would wrap. */
#define OLDEST_MS 86400000

void look_init(look_t *look)
{
    memset(look, 0, sizeof *look);
    look->clear = true;
    look->dark_ms = FIRST_PAUSE_MS / LIT_SHARE;
    look->pause_ms = FIRST_PAUSE_MS;
}

static void go_on(look_t *look, look_state_t state, uint32_t now_ms)
{
    look->state = state;
    look->since_ms = now_ms;
    look->due = false;
}

static void end_look(look_t *look, uint32_t now_ms)
{
    look->dark_ms = now_ms - look->since_ms;
    look->pause_ms = LIT_SHARE * look->dark_ms;
    if (look->clear && look->pause_ms < CLEAR_PAUSE_MS)
        look->pause_ms = CLEAR_PAUSE_MS;
    go_on(look, LOOK_LIT, now_ms);
}

void look_turn(look_t *look, look_lamps_t lamps, uint32_t now_ms)
{
    if (now_ms - look->since_ms > OLDEST_MS)
        look->since_ms = now_ms - OLDEST_MS;
    if (look->state == LOOK_UNLIT && lamps.lit)
        go_on(look, LOOK_LIT, now_ms);
    if (!lamps.follows)
        look->due = false;
    if (look->state == LOOK_LIT && look->due)
        go_on(look, LOOK_DARK, now_ms);
    if (look->state == LOOK_DARK &&
        (!lamps.follows || now_ms - look->since_ms >= LOOK_LONGEST_MS)) {
        look->failed = lamps.follows;
        end_look(look, now_ms);
    }
}

bool look_is_on(const look_t *look)
{
    return look->state == LOOK_DARK;
}

bool look_waits(const look_t *look)
{
    return look->due || look->state == LOOK_DARK;
}

static look_seen_t seen_in(const decision_t *decision)
{
    return (look_seen_t){true, decision->background.meaningful,
                         decision->background.value, decision->decided_hue};
}

/* Whether a frame without the lamps' light says what one with it says. */
static bool agree(const look_seen_t *dark, const look_seen_t *lit)
{
    return dark->known && lit->known && dark->meaningful == lit->meaningful &&
           hue_distance(dark->hue, lit->hue) <= SAME_HUE;
}

/* What decided up to here was perhaps the lamps' own light. */
static void doubt(look_t *look, decision_t *decision)
{
    if (!look->clear)
        return;
    look->clear = false;
    look->pause_ms = LIT_SHARE * look->dark_ms;
    decision_forget(decision);
}

/* Water that has the lamps' hue by itself is not meant. */
static bool looks_like_lamps(const look_t *look, const decision_t *decision)
{
    return decision->background.meaningful &&
           hue_distance(decision->background.hue, decision->steady.shown) <
               OWN_HUE &&
           !agree(&look->dark, &look->lit);
}

/* A look without a frame: the camera is too slow.  By day that does no harm. */
static void after_failure(look_t *look, decision_t *decision,
                          const dock_settings_t *settings, bool own,
                          uint32_t now_ms)
{
    look->failed = false;
    if (look->clear)
        return;
    if (look->lit.value >= DECISION_DIM_VALUE && !own)
        look->clear = true;
    else
        decision_take_none(decision, settings, DECISION_NIGHT_WINDOW_MS,
                           now_ms);
}

static void lit_frame(look_t *look, decision_t *decision,
                      const dock_settings_t *settings, bool follows,
                      uint32_t now_ms)
{
    const bool first = !look->lit.known;
    look->lit = seen_in(decision);
    const bool own = follows && looks_like_lamps(look, decision);
    if (first && look->dark.known && !agree(&look->dark, &look->lit))
        doubt(look, decision);
    if (look->failed)
        after_failure(look, decision, settings, own, now_ms);
    const bool taken = (look->clear || !follows) &&
                       decision_take(decision, settings->window_ms, now_ms);
    if (!follows || (!own && (taken || !decision_is_dim(decision))))
        hold_begin(&look->odd, now_ms);
    else if (hold_ends(&look->odd, DOUBT_MS, HOLD_FRAMES, now_ms))
        doubt(look, decision);
}

static void dark_frame(look_t *look, decision_t *decision,
                       const dock_settings_t *settings, uint32_t now_ms)
{
    look->dark = seen_in(decision);
    if (agree(&look->dark, &look->lit))
        look->clear = true;
    else
        doubt(look, decision);
    look->failed = false;
    decision_take(decision,
                  look->clear ? settings->window_ms : DECISION_NIGHT_WINDOW_MS,
                  now_ms);
    end_look(look, now_ms);
    hold_begin(&look->odd, now_ms);
}

void look_frame(look_t *look, decision_t *decision,
                const dock_settings_t *settings, bool follows,
                uint32_t light_from_ms, uint32_t now_ms)
{
    if (look->state == LOOK_UNLIT || !decision->decided) {
        decision_take(decision, settings->window_ms, now_ms);
        hold_begin(&look->odd, now_ms);
        look->dark = seen_in(decision);
        look->dark.known = look->state == LOOK_UNLIT;
        return;
    }
    /* Else the lamps went out or on while it was exposed. */
    const bool whole = light_from_ms - look->since_ms <= INT32_MAX;
    if (whole && look->state == LOOK_DARK)
        dark_frame(look, decision, settings, now_ms);
    else if (whole)
        lit_frame(look, decision, settings, follows, now_ms);
    else if (look->clear && look->lit.known)
        decision_take(decision, settings->window_ms, now_ms);
    /* Right after a frame, or that frame would be lost to the look. */
    if (follows && look->state == LOOK_LIT &&
        now_ms - look->since_ms >= look->pause_ms)
        look->due = true;
}
