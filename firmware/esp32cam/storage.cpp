#include "storage.h"

#include <nvs.h>
#include <nvs_flash.h>

static const char NAMESPACE[] = "chromadock";
static const char KEY[] = "settings";

/* False where what the partition held is lost. */
static bool start_flash()
{
    const esp_err_t error = nvs_flash_init();
    if (error == ESP_OK)
        return true;
    if (error == ESP_ERR_NVS_NO_FREE_PAGES ||
        error == ESP_ERR_NVS_NEW_VERSION_FOUND) {
        nvs_flash_erase();
        nvs_flash_init();
    }
    return false;
}

static storage_result_t load(dock_settings_t *settings)
{
    if (!start_flash())
        return STORAGE_CORRUPT;
    nvs_handle_t handle;
    esp_err_t error = nvs_open(NAMESPACE, NVS_READONLY, &handle);
    if (error == ESP_ERR_NVS_NOT_FOUND)
        return STORAGE_MISSING;
    if (error != ESP_OK)
        return STORAGE_CORRUPT;
    uint8_t blob[SETTINGS_BLOB_BYTES];
    size_t length = sizeof blob;
    error = nvs_get_blob(handle, KEY, blob, &length);
    nvs_close(handle);
    if (error == ESP_ERR_NVS_NOT_FOUND)
        return STORAGE_MISSING;
    if (error != ESP_OK || !settings_from_blob(settings, blob, length))
        return STORAGE_CORRUPT;
    return STORAGE_LOADED;
}

storage_result_t storage_load(dock_settings_t *settings)
{
    *settings = dock_default_settings();
    return load(settings);
}

bool storage_save(const dock_settings_t &settings)
{
    uint8_t blob[SETTINGS_BLOB_BYTES];
    settings_to_blob(&settings, blob);
    nvs_handle_t handle;
    if (nvs_open(NAMESPACE, NVS_READWRITE, &handle) != ESP_OK)
        return false;
    const bool written =
        nvs_set_blob(handle, KEY, blob, sizeof blob) == ESP_OK &&
        nvs_commit(handle) == ESP_OK;
    nvs_close(handle);
    return written;
}
