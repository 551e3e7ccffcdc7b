/* ESP-IDF 4.4.7 and 5.5: components/esp_timer/include/esp_timer.h. */
#ifndef ESP_TIMER_H
#define ESP_TIMER_H

#include <stdint.h>

extern "C" int64_t esp_timer_get_time(void);

#endif
