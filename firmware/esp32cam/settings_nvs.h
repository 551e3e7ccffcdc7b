/* The settings' blob in NVS, its first place.
 *
 * Arduino starts NVS before setup(), and erases all of it where it finds it
 * damaged: hence the second place, settings_sector.h. */
#ifndef SETTINGS_NVS_H
#define SETTINGS_NVS_H

#include "stored_blob.h"

void settings_nvs_load(stored_blob_t *blob);

/* True where NVS has taken all of it. */
bool settings_nvs_save(const uint8_t *bytes, size_t length);

#endif
