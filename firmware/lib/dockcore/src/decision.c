#include "decision.h"

#include <string.h>

#include "counter.h"
#include "marker.h"

void decision_init(decision_t *decision)
{
    memset(decision, 0, sizeof *decision);
    rolling_init(&decision->rolling);
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

bool decision_frame(decision_t *decision, const frame_t *frame,
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
    decision->marker_hue = rolling_add(
        &decision->rolling, decision->decided_hue, now_ms, settings->window_ms);
    decision->decided = true;
    return true;
}

void decision_refuse(decision_t *decision)
{
    decision->refused = true;
}

uint16_t decision_rate_dhz(const decision_t *decision)
{
    if (decision->frame_period_q8 == 0)
        return 0;
    const uint32_t rate = UINT32_C(10000) * 256 / decision->frame_period_q8;
    return (uint16_t)(rate < UINT16_MAX ? rate : UINT16_MAX);
}
