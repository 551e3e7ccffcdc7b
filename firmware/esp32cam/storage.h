/* The settings in flash, in two places, so that one of them is whole at any
 * moment.  Written only on request, while the camera is paused, and at the
 * start, before it runs: flash writes stop everything that runs from flash. */
#ifndef STORAGE_H
#define STORAGE_H

#include "core.h"

/* The stored settings; the defaults if there are none that can be read.  Where
 * the two places differ, the blob that is in use is written to the other. */
dock_stored_t storage_load(dock_settings_t *settings);

/* True where both places hold them now.  If the power fails meanwhile, the next
 * start has these settings or those saved before. */
bool storage_save(const dock_settings_t &settings);

#endif
