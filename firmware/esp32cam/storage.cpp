#include "storage.h"

#include <string.h>

#include "settings_nvs.h"
#include "settings_sector.h"

static bool same(const stored_blob_t &a, const stored_blob_t &b)
{
    return a.length == b.length && memcmp(a.bytes, b.bytes, a.length) == 0;
}

dock_stored_t storage_load(dock_settings_t *settings)
{
    stored_blob_t first, second;
    settings_nvs_load(&first);
    settings_sector_load(&second);
    *settings = dock_default_settings();

    settings_read_t read =
        settings_from_blob(settings, first.bytes, first.length);
    if (read != SETTINGS_REFUSED) {
        if (!same(first, second))
            settings_sector_save(first.bytes, first.length);
        return read == SETTINGS_MENDED ? DOCK_STORED_IN_PART
                                       : DOCK_STORED_WHOLE;
    }
    read = settings_from_blob(settings, second.bytes, second.length);
    if (read != SETTINGS_REFUSED) {
        settings_nvs_save(second.bytes, second.length);
        return read == SETTINGS_MENDED ? DOCK_STORED_IN_PART
                                       : DOCK_STORED_RESTORED;
    }
    return first.missing && second.missing ? DOCK_STORED_WHOLE
                                           : DOCK_STORED_LOST;
}

bool storage_save(const dock_settings_t &settings)
{
    uint8_t blob[SETTINGS_BLOB_BYTES];
    settings_to_blob(&settings, blob);
    /* One after the other: the second place is touched only when the first one
     * is whole. */
    return settings_nvs_save(blob, sizeof blob) &&
           settings_sector_save(blob, sizeof blob);
}
