/* ESP-IDF 4.4.7 and 5.5: components/nvs_flash/include/nvs_flash.h. */
#ifndef NVS_FLASH_H
#define NVS_FLASH_H

#include "nvs.h"

extern "C" {

esp_err_t nvs_flash_init(void);
esp_err_t nvs_flash_erase(void);
}

#endif
