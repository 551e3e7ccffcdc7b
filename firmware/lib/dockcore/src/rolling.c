#include "rolling.h"

#include "hue.h"

void rolling_init(rolling_t *rolling)
{
    rolling->first = 0;
    rolling->count = 0;
}

static uint8_t slot(const rolling_t *rolling, uint32_t index)
{
    const uint32_t at = rolling->first + index;
    return (uint8_t)(at < METHOD_WINDOW_CAPACITY ? at
                                                 : at - METHOD_WINDOW_CAPACITY);
}

static void drop_oldest(rolling_t *rolling)
{
    rolling->first = slot(rolling, 1);
    rolling->count--;
}

uint16_t rolling_add(rolling_t *rolling, uint16_t hue, uint32_t now_ms,
                     uint32_t window_ms)
{
    if (rolling->count == METHOD_WINDOW_CAPACITY)
        drop_oldest(rolling);
    const uint8_t newest = slot(rolling, rolling->count++);
    rolling->time_ms[newest] = now_ms;
    rolling->hue[newest] = hue;

    hue_vector_t sum = {0, 0};
    uint8_t kept = 0;
    for (uint8_t i = 0; i < rolling->count; i++) {
        const uint8_t from = slot(rolling, i);
        if (now_ms - rolling->time_ms[from] >= window_ms)
            continue;
        const uint8_t to = slot(rolling, kept++);
        rolling->time_ms[to] = rolling->time_ms[from];
        rolling->hue[to] = rolling->hue[from];
        sum.x += hue_cos(rolling->hue[to]);
        sum.y += hue_sin(rolling->hue[to]);
    }
    rolling->count = kept;

    uint16_t mean = hue;
    hue_of_vector(sum, &mean);
    return mean;
}
