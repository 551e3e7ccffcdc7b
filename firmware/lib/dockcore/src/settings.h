/* What a user can set and the dock keeps over a restart.  Ranges, defaults and
 * meanings: shared/parameters.toml. */
#ifndef SETTINGS_H
#define SETTINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "led.h"

typedef struct {
    uint8_t lock;          /* 1: exposure, gain and white balance fixed */
    uint16_t exposure;     /* sensor lines; 0: as settled */
    int8_t gain;           /* sensor units; -1: as settled */
    uint8_t white_balance; /* the OV2640's presets 1..4; 0: as settled */
} camera_settings_t;

typedef struct {
    uint8_t mapping;       /* METHOD_MAPPING_... */
    uint16_t fallback_hue; /* marker where the water's hue means nothing */
    uint16_t window_ms;    /* METHOD_MIN_WINDOW_MS..METHOD_MAX_WINDOW_MS */
    uint8_t led_mode;      /* 0: automatic, 1: led_hue */
    uint16_t led_hue;
    led_settings_t led;
    camera_settings_t camera;
    uint8_t report_hz;
    uint32_t link_baud; /* from the next start on */
    uint8_t system_id;  /* MAVLink's, from the next start on */
} dock_settings_t;

dock_settings_t dock_default_settings(void);

/* True where every parameter is in its range. */
bool dock_settings_are_valid(const dock_settings_t *settings);

/* For flash: version, every parameter, CRC-32. */
#define SETTINGS_BLOB_BYTES 116

void settings_to_blob(const dock_settings_t *settings,
                      uint8_t blob[SETTINGS_BLOB_BYTES]);

/* False, *settings untouched, for a blob of another length or version, a wrong
 * CRC or a value out of range. */
bool settings_from_blob(dock_settings_t *settings, const uint8_t *blob,
                        size_t length);

#endif
