/* The settings as bytes, for flash.
 *
 *   format          4 bytes, SETTINGS_BLOB_FORMAT
 *   entries         4 bytes, how many follow
 *   each entry      4 bytes key of the parameter, 4 bytes stored value
 *   checksum        4 bytes, CRC-32 of all before it
 *
 * All of them little-endian.  A parameter is found by its key and not by its
 * place, so that firmware with more, fewer or renamed fields reads the blob.
 * The key is the CRC-32 of the parameter's name and scale: a parameter whose
 * stored number gets another meaning needs another name or scale. */
#ifndef SETTINGS_BLOB_H
#define SETTINGS_BLOB_H

#include <stddef.h>
#include <stdint.h>

#include "parameter_table.h"
#include "settings.h"

#define SETTINGS_BLOB_FORMAT UINT32_C(0x31534443) /* "CDS1" */

/* Of a blob that this firmware writes. */
#define SETTINGS_BLOB_BYTES (8 + 8 * PARAMETER_COUNT + 4)

/* The longest blob that has to be read: later firmware may have more. */
#define SETTINGS_BLOB_LONGEST 1024

typedef enum {
    SETTINGS_REFUSED, /* not a whole blob: the settings are not touched */
    SETTINGS_MENDED,  /* read; a value out of its range became the default */
    SETTINGS_READ,
} settings_read_t;

/* Key of a parameter in the blob. */
uint32_t settings_key(const parameter_t *parameter);

void settings_to_blob(const dock_settings_t *settings,
                      uint8_t blob[SETTINGS_BLOB_BYTES]);

/* Reads a blob of `length` bytes.  Entries of unknown key are skipped, and a
 * parameter without an entry gets its default.  A blob of the format before
 * this one is read as well (settings_table.h). */
settings_read_t settings_from_blob(dock_settings_t *settings,
                                   const uint8_t *blob, size_t length);

#endif
