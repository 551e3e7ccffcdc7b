/* The flash, of board.h: NVS and one partition, written step by step, so that
 * the power can fail between any two of them. */
#ifndef FAKE_FLASH_H
#define FAKE_FLASH_H

enum { SECTOR_BYTES = 4096, NVS_ENTRY_BYTES = 32 };

inline FakeFlash blank_flash()
{
    FakeFlash flash = FakeFlash();
    flash.sector = std::string(SECTOR_BYTES, '\xFF');
    flash.power = FOREVER;
    return flash;
}

/* One write that the chip does or does not do. */
inline void flash_step()
{
    if (board.flash.power == 0)
        throw PowerLost();
    if (board.flash.power > 0)
        --board.flash.power;
}

/* What core 2.0.17 and 3.3 do before setup(), in esp32-hal-misc.c: NVS that
 * cannot be started is erased. */
inline void init_arduino()
{
    const esp_err_t error = board.flash.init_error;
    if (error == ESP_ERR_NVS_NO_FREE_PAGES ||
        error == ESP_ERR_NVS_NEW_VERSION_FOUND) {
        note("NVS erased by Arduino");
        board.flash.stored = false;
        board.flash.blob.clear();
        board.flash.init_error = ESP_OK;
    }
}

static const esp_partition_t fake_partition = {};

extern "C" {

esp_err_t nvs_flash_init(void)
{
    note("nvs_flash_init");
    return board.flash.init_error;
}

esp_err_t nvs_open(const char *name, nvs_open_mode_t mode, nvs_handle_t *handle)
{
    note(std::string("nvs_open ") + name);
    if (board.flash.init_error != ESP_OK)
        return ESP_ERR_NVS_NOT_INITIALIZED;
    if (board.flash.open_error != ESP_OK)
        return board.flash.open_error;
    if (mode == NVS_READONLY && !board.flash.stored)
        return ESP_ERR_NVS_NOT_FOUND;
    ++board.flash.handles_open;
    *handle = 7;
    return ESP_OK;
}

esp_err_t nvs_get_blob(nvs_handle_t, const char *key, void *value,
                       size_t *length)
{
    const std::string &blob = board.flash.blob;
    note(std::string("nvs_get_blob ") + key);
    if (board.flash.get_error != ESP_OK)
        return board.flash.get_error;
    if (*length < blob.size())
        return ESP_ERR_NVS_INVALID_LENGTH;
    *length = blob.size();
    memcpy(value, blob.data(), blob.size());
    return ESP_OK;
}

/* The new blob's entries beside the old ones, then its index, by which it takes
 * their place; or, torn, worse than the real one: over the old blob. */
esp_err_t nvs_set_blob(nvs_handle_t, const char *key, const void *value,
                       size_t length)
{
    FakeFlash &flash = board.flash;
    note(std::string("nvs_set_blob ") + key);
    if (flash.set_error != ESP_OK)
        return flash.set_error;
    const std::string blob(static_cast<const char *>(value), length);
    for (size_t at = 0; at < length; at += NVS_ENTRY_BYTES) {
        flash_step();
        if (flash.torn) {
            flash.blob = blob.substr(0, at) + '\xFF';
            flash.stored = true;
        }
    }
    flash_step();
    flash.blob = blob;
    flash.stored = true;
    flash_step(); /* the old entries go */
    return ESP_OK;
}

esp_err_t nvs_commit(nvs_handle_t)
{
    note("nvs_commit");
    return board.flash.commit_error;
}

void nvs_close(nvs_handle_t)
{
    --board.flash.handles_open;
}

const esp_partition_t *esp_partition_find_first(esp_partition_type_t type,
                                                esp_partition_subtype_t subtype,
                                                const char *)
{
    const bool known = type == ESP_PARTITION_TYPE_DATA &&
                       subtype == ESP_PARTITION_SUBTYPE_DATA_SPIFFS;
    return known && !board.flash.without_sector ? &fake_partition : nullptr;
}

esp_err_t esp_partition_read(const esp_partition_t *, size_t from, void *to,
                             size_t size)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT(SECTOR_BYTES, from + size);
    memcpy(to, board.flash.sector.data() + from, size);
    return ESP_OK;
}

/* A write only clears bits. */
esp_err_t esp_partition_write(const esp_partition_t *, size_t to,
                              const void *from, size_t size)
{
    note("esp_partition_write", static_cast<long>(to), static_cast<long>(size));
    if (board.flash.write_error != ESP_OK)
        return board.flash.write_error;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(SECTOR_BYTES, to + size);
    for (size_t i = 0; i < size; i++) {
        flash_step();
        char &cell = board.flash.sector[to + i];
        cell = static_cast<char>(cell & static_cast<const char *>(from)[i]);
    }
    return ESP_OK;
}

/* An erase that is broken off leaves anything; here half of it. */
esp_err_t esp_partition_erase_range(const esp_partition_t *, size_t from,
                                    size_t size)
{
    note("esp_partition_erase_range", static_cast<long>(from),
         static_cast<long>(size));
    if (board.flash.erase_error != ESP_OK)
        return board.flash.erase_error;
    TEST_ASSERT_EQUAL_UINT(0, from % SECTOR_BYTES);
    TEST_ASSERT_EQUAL_UINT(SECTOR_BYTES, size);
    for (int half = 0; half < 2; half++) {
        flash_step();
        board.flash.sector.replace(half == 0 ? SECTOR_BYTES / 2 : 0,
                                   SECTOR_BYTES / 2, SECTOR_BYTES / 2, '\xFF');
    }
    return ESP_OK;
}

} /* extern "C" */

/* A blob as the flash of a dock has it, in NVS alone or in both places. */
inline void store_in_nvs(const std::string &blob)
{
    board.flash.blob = blob;
    board.flash.stored = true;
}

inline std::string blob_of(const dock_settings_t &settings)
{
    uint8_t blob[SETTINGS_BLOB_BYTES];
    settings_to_blob(&settings, blob);
    return std::string(reinterpret_cast<const char *>(blob), sizeof blob);
}

inline void store_in_both(const std::string &blob)
{
    store_in_nvs(blob);
    const uint32_t length = static_cast<uint32_t>(blob.size());
    board.flash.sector =
        "DOCK" + std::string(reinterpret_cast<const char *>(&length), 4) + blob;
    board.flash.sector +=
        std::string(SECTOR_BYTES - board.flash.sector.size(), '\xFF');
}

#endif
