#include "settings.h"

#include <string.h>

#include "parameter_table.h"

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

dock_settings_t dock_reset_settings(const dock_settings_t *now)
{
    dock_settings_t settings = dock_default_settings();
    settings.led.limit = now->led.limit;
    settings.led.common_anode = now->led.common_anode;
    return settings;
}

int dock_mend_settings(dock_settings_t *settings)
{
    int mended = 0;
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const int32_t value = parameter_get(&PARAMETERS[i], settings);
        if (value >= PARAMETERS[i].minimum && value <= PARAMETERS[i].maximum)
            continue;
        parameter_set(&PARAMETERS[i], settings, PARAMETERS[i].initial);
        mended++;
    }
    return mended;
}
