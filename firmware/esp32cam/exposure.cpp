#include "exposure.h"

uint32_t Exposure::age_ms(int64_t began_us, int64_t now_us)
{
    const int64_t apart = began_us - last_us;
    apart_us[next] = apart > 0 && apart < UNKNOWN_US ? apart : UNKNOWN_US;
    next = (next + 1) % KEPT;
    last_us = began_us;
    int64_t period_us = UNKNOWN_US;
    for (const int64_t candidate : apart_us)
        if (candidate < period_us)
            period_us = candidate;
    /* Whole milliseconds, and none too few. */
    return static_cast<uint32_t>((now_us - began_us + period_us) / 1000 + 1);
}
