/* The settings' blob in NVS.  Written only on request, while the camera is
 * paused: flash writes stop everything that runs from flash or PSRAM. */
#ifndef STORAGE_H
#define STORAGE_H

#include "core.h"

enum storage_result_t {
    STORAGE_LOADED,
    STORAGE_MISSING, /* never saved: a first start */
    STORAGE_CORRUPT, /* something else than a valid blob, or no answer */
};

/* The stored settings; the defaults if there are none that can be used. */
storage_result_t storage_load(dock_settings_t *settings);

/* True where the flash has taken all of it. */
bool storage_save(const dock_settings_t &settings);

#endif
