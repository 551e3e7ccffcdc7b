#include "settings_sector.h"

#include <esp_partition.h>

enum {
    SECTOR = 4096, /* what can be erased alone */
    HEADER = 8,    /* mark and length, then the blob */
};

/* What begins with it was written here; anything else is not ours. */
static const uint32_t MARK = 0x4B434F44; /* "DOCK" */

static const esp_partition_t *find()
{
    return esp_partition_find_first(ESP_PARTITION_TYPE_DATA,
                                    ESP_PARTITION_SUBTYPE_DATA_SPIFFS, nullptr);
}

void settings_sector_load(stored_blob_t *blob)
{
    blob->length = 0;
    blob->missing = true;
    const esp_partition_t *partition = find();
    uint32_t header[HEADER / 4];
    if (partition == nullptr ||
        esp_partition_read(partition, 0, header, HEADER) != ESP_OK ||
        header[0] != MARK)
        return;
    blob->missing = false;
    const size_t length = header[1];
    if (length <= sizeof blob->bytes &&
        esp_partition_read(partition, HEADER, blob->bytes, length) == ESP_OK)
        blob->length = length;
}

bool settings_sector_save(const uint8_t *bytes, size_t length)
{
    const esp_partition_t *partition = find();
    if (partition == nullptr)
        return true;
    const uint32_t header[] = {MARK, static_cast<uint32_t>(length)};
    /* The mark last: it says that all the rest is there. */
    return esp_partition_erase_range(partition, 0, SECTOR) == ESP_OK &&
           esp_partition_write(partition, HEADER, bytes, length) == ESP_OK &&
           esp_partition_write(partition, 0, header, HEADER) == ESP_OK;
}
