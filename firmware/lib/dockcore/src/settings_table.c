#include "settings_table.h"

#include "bytes32.h"

#define VERSION UINT32_C(0x302025fa)

/* In the order of their values in the blob. */
static const uint8_t ORDER[] = {
    PARAMETER_MAPPING,      PARAMETER_WINDOW_MS,    PARAMETER_FALLBACK_HUE,
    PARAMETER_LED_MODE,     PARAMETER_LED_HUE,      PARAMETER_LED_OFFSET_R,
    PARAMETER_LED_OFFSET_G, PARAMETER_LED_OFFSET_B, PARAMETER_LED_M_RR,
    PARAMETER_LED_M_RG,     PARAMETER_LED_M_RB,     PARAMETER_LED_M_GR,
    PARAMETER_LED_M_GG,     PARAMETER_LED_M_GB,     PARAMETER_LED_M_BR,
    PARAMETER_LED_M_BG,     PARAMETER_LED_M_BB,     PARAMETER_LED_GAMMA,
    PARAMETER_LED_LIMIT,    PARAMETER_LED_ANODE,    PARAMETER_CAM_LOCK,
    PARAMETER_CAM_EXPOSURE, PARAMETER_CAM_GAIN,     PARAMETER_CAM_WB,
    PARAMETER_REPORT_HZ,    PARAMETER_LINK_BAUD,
};

enum {
    COUNT = sizeof ORDER,
    BYTES = 4 * (COUNT + 2),
};

settings_read_t settings_from_table(dock_settings_t *settings,
                                    const uint8_t *blob, size_t length)
{
    if (length != BYTES || get32(blob) != VERSION ||
        get32(blob + BYTES - 4) != crc32(0, blob, BYTES - 4))
        return SETTINGS_REFUSED;
    settings_read_t result = SETTINGS_READ;
    dock_settings_t read = dock_default_settings();
    for (int i = 0; i < COUNT; i++)
        if (!parameter_set(&PARAMETERS[ORDER[i]], &read,
                           (int32_t)get32(blob + 4 * (i + 1))))
            result = SETTINGS_MENDED;
    *settings = read;
    return result;
}
