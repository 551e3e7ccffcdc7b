#include "backoff.h"

void Backoff::fail(uint32_t now_ms)
{
    failed_ms = now_ms;
    if (delay == 0)
        delay = BACKOFF_FIRST_MS;
    else if (delay < BACKOFF_LONGEST_MS)
        delay *= 2;
}

void Backoff::succeed()
{
    delay = 0;
}

bool Backoff::due(uint32_t now_ms) const
{
    return now_ms - failed_ms >= delay;
}

uint32_t Backoff::delay_ms() const
{
    return delay;
}
