/* What the LEDs show: the marker's hue, or what a person wants to see instead.
 *
 * Only lamps.c writes the fields; everybody may read them. */
#ifndef LAMPS_H
#define LAMPS_H

#include <stdint.h>

#include "decision.h"
#include "settings.h"

typedef struct {
    uint8_t mode;   /* DOCK_LED_AUTO, _HUE, _RAW of chromadock.xml */
    uint16_t hue;   /* shown in mode DOCK_LED_HUE */
    uint8_t raw[3]; /* R G B, shown in mode DOCK_LED_RAW */
} lamps_t;

/* Starts as the settings say. */
void lamps_init(lamps_t *lamps, const dock_settings_t *settings);

/* Goes over to what the settings say where they changed in that. */
void lamps_follow(lamps_t *lamps, const dock_settings_t *before,
                  const dock_settings_t *now);

/* Each until the next of these calls, or the next change of the settings. */
void lamps_show_marker(lamps_t *lamps);
void lamps_show_hue(lamps_t *lamps, uint16_t hue);
void lamps_show_raw(lamps_t *lamps, const uint8_t rgb[3]);

/* PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity.  Dark
 * where the marker's hue is wanted before the first decision. */
void lamps_duties(const lamps_t *lamps, const decision_t *decision,
                  const led_settings_t *led, uint16_t duty[3]);

#endif
