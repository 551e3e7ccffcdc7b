#include "settings.h"

#include <string.h>

#include "parameter_table.h"

_Static_assert(SETTINGS_BLOB_BYTES == 4 * (PARAMETER_COUNT + 2),
               "version, values, checksum");
_Static_assert(sizeof(dock_settings_t) < 256, "parameter_t.offset is a byte");
/* Fields are read byte by byte. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "little-endian only");

dock_settings_t dock_default_settings(void)
{
    dock_settings_t settings;
    memset(&settings, 0, sizeof settings);
    for (int i = 0; i < PARAMETER_COUNT; i++)
        parameter_set(&PARAMETERS[i], &settings, PARAMETERS[i].initial);
    return settings;
}

bool dock_settings_are_valid(const dock_settings_t *settings)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const int32_t value = parameter_get(&PARAMETERS[i], settings);
        if (value < PARAMETERS[i].minimum || value > PARAMETERS[i].maximum)
            return false;
    }
    return true;
}

/* CRC-32 of IEEE 802.3, as zlib computes it. */
static uint32_t crc32(const uint8_t *bytes, size_t n)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < n; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ ((crc & 1) != 0 ? UINT32_C(0xEDB88320) : 0);
    }
    return ~crc;
}

static void put32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> 8 * i);
}

static uint32_t get32(const uint8_t *from)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value |= (uint32_t)from[i] << 8 * i;
    return value;
}

void settings_to_blob(const dock_settings_t *settings,
                      uint8_t blob[SETTINGS_BLOB_BYTES])
{
    put32(blob, PARAMETER_TABLE_VERSION);
    for (int i = 0; i < PARAMETER_COUNT; i++)
        put32(blob + 4 * (i + 1),
              (uint32_t)parameter_get(&PARAMETERS[i], settings));
    const size_t content = SETTINGS_BLOB_BYTES - 4;
    put32(blob + content, crc32(blob, content));
}

bool settings_from_blob(dock_settings_t *settings, const uint8_t *blob,
                        size_t length)
{
    const size_t content = SETTINGS_BLOB_BYTES - 4;
    if (length != SETTINGS_BLOB_BYTES ||
        get32(blob) != PARAMETER_TABLE_VERSION ||
        get32(blob + content) != crc32(blob, content))
        return false;
    dock_settings_t read = dock_default_settings();
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const int32_t value = (int32_t)get32(blob + 4 * (i + 1));
        if (!parameter_set(&PARAMETERS[i], &read, value))
            return false;
    }
    *settings = read;
    return true;
}
