#include "watchdog.h"

#include <esp_idf_version.h>
#include <esp_task_wdt.h>

void watchdog_start()
{
#if ESP_IDF_VERSION_MAJOR >= 5
    esp_task_wdt_config_t config = {};
    config.timeout_ms = 1000 * WATCHDOG_SECONDS;
    config.idle_core_mask = 1; /* core 0's idle task, as Arduino sets it */
    config.trigger_panic = true;
    /* Arduino has started it; where it has not, this says so. */
    if (esp_task_wdt_reconfigure(&config) != ESP_OK)
        esp_task_wdt_init(&config);
#else
    esp_task_wdt_init(WATCHDOG_SECONDS, true);
#endif
    esp_task_wdt_add(nullptr);
}

void watchdog_feed()
{
    esp_task_wdt_reset();
}
