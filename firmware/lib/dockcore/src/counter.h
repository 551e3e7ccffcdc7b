/* Counters that stay at their largest value instead of starting again at 0. */
#ifndef COUNTER_H
#define COUNTER_H

#include <stdint.h>

static inline void count(uint32_t *counter)
{
    if (*counter < UINT32_MAX)
        ++*counter;
}

#endif
