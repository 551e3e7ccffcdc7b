#include "decision.h"

#include <string.h>

#include "counter.h"
#include "marker.h"

#define DIM_HOLD_MS 30000
#define DIM_SAMPLE_MS (DECISION_NIGHT_WINDOW_MS / METHOD_WINDOW_CAPACITY)
/* What comes on slowly, as a lamp does too, is compared with what was then. */
#define DIM_MARK_MS 10000
/* How far a value may be from the one before, and a hue from the one shown. */
#define LIKE_VALUE(value) (4 + (value) / 4)
#define LIKE_HUE (15 * METHOD_HUE_RANGE / 360)

void decision_init(decision_t *decision, uint16_t hue)
{
    memset(decision, 0, sizeof *decision);
    steady_init(&decision->steady);
    steady_show(&decision->steady, hue);
}

/* Keeps the mean over about the last eight frames. */
static void measure_rate(decision_t *decision, uint32_t now_ms)
{
    const uint32_t longest = 60000;
    const uint32_t apart = now_ms - decision->last_frame_ms;
    const uint32_t period = 256 * (apart == 0        ? 1
                                   : apart < longest ? apart
                                                     : longest);
    if (decision->frames > 0)
        decision->frame_period_q8 =
            decision->frame_period_q8 == 0
                ? period
                : (7 * decision->frame_period_q8 + period) / 8;
    decision->last_frame_ms = now_ms;
}

bool decision_see(decision_t *decision, const frame_t *frame,
                  const dock_settings_t *settings, uint32_t now_ms)
{
    decision->refused = !frame_is_valid(frame);
    if (decision->refused) {
        count(&decision->frame_faults);
        return false;
    }
    measure_rate(decision, now_ms);
    count(&decision->frames);
    smoothed_open(&decision->smoothed, frame);
    background_from_rows(&decision->background, smoothed_rows,
                         &decision->smoothed, decision->background.bin);
    decision->decided_hue = marker_hue(&decision->background, settings->mapping,
                                       settings->fallback_hue);
    return true;
}

bool decision_is_dim(const decision_t *decision)
{
    return decision->decided && decision->water_value < DECISION_DIM_VALUE;
}

static bool is_near(const decision_t *decision, const decision_mark_t *mark)
{
    const int brighter = decision->background.value - mark->value;
    const int most = LIKE_VALUE(mark->value);
    return brighter <= most && -brighter <= most &&
           hue_distance(decision->decided_hue, mark->hue) <= LIKE_HUE;
}

/* Whether what was seen goes with what was taken before. */
static bool is_like(const decision_t *decision)
{
    const bool meaningful = decision->background.meaningful;
    if (!decision->decided || meaningful != decision->steady.meaningful)
        return false;
    return !decision_is_dim(decision) || !meaningful ||
           is_near(decision, &decision->held);
}

static void take(decision_t *decision, uint32_t window_ms, uint32_t now_ms)
{
    decision->water_hue = decision->background.hue;
    decision->water_value = decision->background.value;
    decision->decided = true;
    decision->sampled_ms = now_ms;
    steady_take(&decision->steady, decision->background.meaningful,
                decision->decided_hue, window_ms, now_ms);
}

static void hold(decision_t *decision, uint32_t now_ms)
{
    decision->held =
        (decision_mark_t){decision->background.value, decision->steady.shown};
    decision->held_ms = now_ms;
}

/* In dim water what is to be taken must have stayed the same while it waited:
 * else it would be the lamp that passes when the wait is over. */
static void wait_for_more(decision_t *decision, uint32_t now_ms)
{
    if (is_near(decision, &decision->other))
        return;
    steady_wait(&decision->steady, now_ms);
    decision->other =
        (decision_mark_t){decision->background.value, decision->decided_hue};
}

static bool take_dim(decision_t *decision, uint32_t now_ms)
{
    const bool like = is_like(decision);
    if (!like)
        wait_for_more(decision, now_ms);
    if (!steady_takes(&decision->steady, like, DIM_HOLD_MS, HOLD_FRAMES,
                      now_ms))
        return false;
    if (like && now_ms - decision->sampled_ms < DIM_SAMPLE_MS) {
        steady_wait(&decision->steady, now_ms);
        return true;
    }
    take(decision, DECISION_NIGHT_WINDOW_MS, now_ms);
    if (!like || now_ms - decision->held_ms >= DIM_MARK_MS)
        hold(decision, now_ms);
    return true;
}

bool decision_take(decision_t *decision, uint32_t window_ms, uint32_t now_ms)
{
    if (decision_is_dim(decision))
        return take_dim(decision, now_ms);
    if (!steady_takes(&decision->steady, is_like(decision), METHOD_HOLD_MS,
                      HOLD_FRAMES, now_ms))
        return false;
    take(decision, window_ms, now_ms);
    hold(decision, now_ms);
    return true;
}

void decision_take_none(decision_t *decision, const dock_settings_t *settings,
                        uint32_t window_ms, uint32_t now_ms)
{
    decision->background.meaningful = false;
    decision->decided_hue = settings->fallback_hue;
    decision_take(decision, window_ms, now_ms);
}

bool decision_frame(decision_t *decision, const frame_t *frame,
                    const dock_settings_t *settings, uint32_t now_ms)
{
    if (!decision_see(decision, frame, settings, now_ms))
        return false;
    steady_takes(&decision->steady, is_like(decision), 0, 1, now_ms);
    take(decision, settings->window_ms, now_ms);
    hold(decision, now_ms);
    steady_let_go(&decision->steady);
    return true;
}

void decision_refuse(decision_t *decision)
{
    decision->refused = true;
}

void decision_forget(decision_t *decision)
{
    steady_show(&decision->steady, decision->steady.shown);
}

void decision_follow(decision_t *decision, const dock_settings_t *before,
                     const dock_settings_t *now)
{
    if (before->mapping == now->mapping &&
        before->fallback_hue == now->fallback_hue)
        return;
    if (!decision->decided) {
        if (decision->steady.shown == before->fallback_hue)
            steady_show(&decision->steady, now->fallback_hue);
        return;
    }
    const background_t water = {.hue = decision->water_hue,
                                .meaningful = decision->steady.meaningful};
    steady_show(&decision->steady,
                marker_hue(&water, now->mapping, now->fallback_hue));
    decision->held.hue = decision->steady.shown;
}

bool decision_is_stale(const decision_t *decision, uint32_t now_ms)
{
    return decision->frames == 0 ||
           now_ms - decision->last_frame_ms >= DECISION_WAIT_MS;
}

uint16_t decision_rate_dhz(const decision_t *decision, uint32_t now_ms)
{
    if (decision->frame_period_q8 == 0 || decision_is_stale(decision, now_ms))
        return 0;
    const uint32_t rate = UINT32_C(10000) * 256 / decision->frame_period_q8;
    return (uint16_t)(rate < UINT16_MAX ? rate : UINT16_MAX);
}
