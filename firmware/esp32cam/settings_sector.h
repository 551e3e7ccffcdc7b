/* The settings' blob in a flash sector of its own, its second place: the first
 * one of the partition "spiffs", which the board's table has and the firmware
 * uses for nothing else.  Arduino leaves it alone, and so does an update of
 * the firmware. */
#ifndef SETTINGS_SECTOR_H
#define SETTINGS_SECTOR_H

#include "stored_blob.h"

void settings_sector_load(stored_blob_t *blob);

/* True where the sector holds it now.  Where the partition table has no such
 * partition there is no second place: true as well, nothing is written. */
bool settings_sector_save(const uint8_t *bytes, size_t length);

#endif
