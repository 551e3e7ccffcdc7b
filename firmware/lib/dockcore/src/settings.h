/* What a user can set and the dock keeps over a restart.  Ranges, defaults and
 * meanings: shared/parameters.toml. */
#ifndef SETTINGS_H
#define SETTINGS_H

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
    uint16_t decision_ms; /* at least, from one to the next; 0: every frame */
    uint32_t link_baud;   /* from the next start on */
    uint8_t system_id;    /* MAVLink's, from the next start on */
} dock_settings_t;

dock_settings_t dock_default_settings(void);

/* The default settings, but the brightness limit and the polarity of the LED
 * outputs as they are in *now: these two belong to the wiring, and with the
 * wrong ones the LEDs would be full on where they should be dark. */
dock_settings_t dock_reset_settings(const dock_settings_t *now);

/* Gives each parameter that is out of its range its default value.  Returns how
 * many these were: 0 if all settings are valid. */
int dock_mend_settings(dock_settings_t *settings);

#endif
