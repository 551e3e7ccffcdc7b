/* Time since the start, by the clock that stamps the camera's frames. */
#ifndef CLOCK_H
#define CLOCK_H

#include <esp_timer.h>
#include <stdint.h>

inline int64_t clock_us()
{
    return esp_timer_get_time();
}

/* Starts again at 0 after 49.7 days: only differences mean something. */
inline uint32_t clock_ms()
{
    return static_cast<uint32_t>(esp_timer_get_time() / 1000);
}

#endif
