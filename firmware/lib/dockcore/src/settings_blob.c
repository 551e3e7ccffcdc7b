#include "settings_blob.h"

#include <string.h>

#include "bytes32.h"
#include "settings_table.h"

enum {
    HEADER = 8,
    ENTRY = 8,
    CHECKSUM = 4,
};

_Static_assert(SETTINGS_BLOB_BYTES <= SETTINGS_BLOB_LONGEST,
               "what is written can be read");

uint32_t settings_key(const parameter_t *parameter)
{
    const uint8_t scale[2] = {parameter->numerator, parameter->shift};
    const uint32_t name =
        crc32(0, (const uint8_t *)parameter->name, strlen(parameter->name));
    return crc32(name, scale, sizeof scale);
}

void settings_to_blob(const dock_settings_t *settings,
                      uint8_t blob[SETTINGS_BLOB_BYTES])
{
    put32(blob, SETTINGS_BLOB_FORMAT);
    put32(blob + 4, PARAMETER_COUNT);
    uint8_t *at = blob + HEADER;
    for (int i = 0; i < PARAMETER_COUNT; i++, at += ENTRY) {
        put32(at, settings_key(&PARAMETERS[i]));
        put32(at + 4, (uint32_t)parameter_get(&PARAMETERS[i], settings));
    }
    put32(at, crc32(0, blob, SETTINGS_BLOB_BYTES - CHECKSUM));
}

static bool is_whole(const uint8_t *blob, size_t length)
{
    if (length < HEADER + CHECKSUM || length > SETTINGS_BLOB_LONGEST ||
        (length - HEADER - CHECKSUM) % ENTRY != 0)
        return false;
    const size_t entries = (length - HEADER - CHECKSUM) / ENTRY;
    return get32(blob) == SETTINGS_BLOB_FORMAT && get32(blob + 4) == entries &&
           get32(blob + length - CHECKSUM) == crc32(0, blob, length - CHECKSUM);
}

/* False where the key is known and the value is out of its range. */
static bool take(dock_settings_t *settings, uint32_t key, int32_t value)
{
    for (int i = 0; i < PARAMETER_COUNT; i++)
        if (settings_key(&PARAMETERS[i]) == key)
            return parameter_set(&PARAMETERS[i], settings, value);
    return true;
}

settings_read_t settings_from_blob(dock_settings_t *settings,
                                   const uint8_t *blob, size_t length)
{
    if (!is_whole(blob, length))
        return settings_from_table(settings, blob, length);
    settings_read_t result = SETTINGS_READ;
    dock_settings_t read = dock_default_settings();
    const uint8_t *const end = blob + length - CHECKSUM;
    for (const uint8_t *at = blob + HEADER; at < end; at += ENTRY)
        if (!take(&read, get32(at), (int32_t)get32(at + 4)))
            result = SETTINGS_MENDED;
    *settings = read;
    return result;
}
