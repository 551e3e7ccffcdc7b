#include "steady.h"

#include <string.h>

void steady_init(steady_t *steady)
{
    memset(steady, 0, sizeof *steady);
    rolling_init(&steady->rolling);
}

void steady_show(steady_t *steady, uint16_t hue)
{
    rolling_init(&steady->rolling);
    steady->shown = hue;
}

void steady_let_go(steady_t *steady)
{
    steady->begun = false;
}

bool steady_takes(steady_t *steady, bool like, uint32_t hold_ms, uint8_t frames,
                  uint32_t now_ms)
{
    if (!like && steady->begun &&
        !hold_ends(&steady->hold, hold_ms, frames, now_ms))
        return false;
    if (!like)
        rolling_init(&steady->rolling);
    return true;
}

void steady_wait(steady_t *steady, uint32_t now_ms)
{
    hold_begin(&steady->hold, now_ms);
}

void steady_take(steady_t *steady, bool meaningful, uint16_t hue,
                 uint32_t window_ms, uint32_t now_ms)
{
    steady->begun = true;
    hold_begin(&steady->hold, now_ms);
    steady->meaningful = meaningful;
    steady->shown = rolling_add(&steady->rolling, hue, now_ms, window_ms);
}

void steady_add(steady_t *steady, bool meaningful, uint16_t hue,
                uint32_t window_ms, uint32_t now_ms)
{
    const bool like = steady->begun && meaningful == steady->meaningful;
    if (steady_takes(steady, like, METHOD_HOLD_MS, 1, now_ms))
        steady_take(steady, meaningful, hue, window_ms, now_ms);
}
