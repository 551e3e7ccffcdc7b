/* The blob of firmware built before 2026-11-29: the values of 26 parameters in
 * the order of that day's table, between the table's version and a CRC-32.  No
 * later firmware writes it; a dock has it until its next `params save`. */
#ifndef SETTINGS_TABLE_H
#define SETTINGS_TABLE_H

#include "settings_blob.h"

/* As settings_from_blob. */
settings_read_t settings_from_table(dock_settings_t *settings,
                                    const uint8_t *blob, size_t length);

#endif
