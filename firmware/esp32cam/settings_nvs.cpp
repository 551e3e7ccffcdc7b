#include "settings_nvs.h"

#include <nvs.h>
#include <nvs_flash.h>

static const char NAMESPACE[] = "chromadock";
static const char KEY[] = "settings";

void settings_nvs_load(stored_blob_t *blob)
{
    blob->length = 0;
    blob->missing = false;
    nvs_handle_t handle;
    /* Has been started, and answers so; or could not be. */
    if (nvs_flash_init() != ESP_OK)
        return;
    esp_err_t error = nvs_open(NAMESPACE, NVS_READONLY, &handle);
    if (error == ESP_OK) {
        size_t length = sizeof blob->bytes;
        error = nvs_get_blob(handle, KEY, blob->bytes, &length);
        nvs_close(handle);
        if (error == ESP_OK)
            blob->length = length;
    }
    blob->missing = error == ESP_ERR_NVS_NOT_FOUND;
}

bool settings_nvs_save(const uint8_t *bytes, size_t length)
{
    nvs_handle_t handle;
    if (nvs_open(NAMESPACE, NVS_READWRITE, &handle) != ESP_OK)
        return false;
    const bool written = nvs_set_blob(handle, KEY, bytes, length) == ESP_OK &&
                         nvs_commit(handle) == ESP_OK;
    nvs_close(handle);
    return written;
}
