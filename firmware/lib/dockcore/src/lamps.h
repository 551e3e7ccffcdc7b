/* What the LEDs show: the marker's hue, or what a person wants to see instead.
 *
 * Only lamps.c writes the fields; everybody may read them. */
#ifndef LAMPS_H
#define LAMPS_H

#include <stdbool.h>
#include <stdint.h>

#include "decision.h"
#include "settings.h"

/* So long the LEDs show what a command asked for: a dock that somebody left
 * like that would be lost to every vehicle. */
#define LAMPS_TEST_MS 600000

typedef struct {
    bool begun;         /* whether lamps_turn was called yet */
    bool overdue;       /* no decision came in time: show a hue all the same */
    uint32_t since_ms;  /* when lamps_turn was first called */
    uint8_t mode;       /* DOCK_LED_AUTO, _HUE, _RAW of chromadock.xml */
    uint16_t hue;       /* shown in mode DOCK_LED_HUE */
    uint8_t raw[3];     /* R G B, shown in mode DOCK_LED_RAW */
    bool testing;       /* a command said what to show, not the settings */
    uint32_t tested_ms; /* when it did */
} lamps_t;

/* Shows what the settings say, and ends a test. */
void lamps_follow(lamps_t *lamps, const dock_settings_t *settings);

/* Each begins a test. */
void lamps_test_marker(lamps_t *lamps, uint32_t now_ms);
void lamps_test_hue(lamps_t *lamps, uint16_t hue, uint32_t now_ms);
void lamps_test_raw(lamps_t *lamps, const uint8_t rgb[3], uint32_t now_ms);

/* Ends a test that has lasted for LAMPS_TEST_MS.  Returns true where it did.
 * To be called more often than the clock wraps. */
bool lamps_expire(lamps_t *lamps, const dock_settings_t *settings,
                  uint32_t now_ms);

/* To be called with every frame and fault and before the lamps are driven, from
 * the start on: sees that a dock without a decision
 * does not stay dark for longer than DECISION_WAIT_MS. */
void lamps_turn(lamps_t *lamps, uint32_t now_ms);

/* Whether they show something: not before the first decision, where it is the
 * marker's hue that is wanted, and it is not overdue. */
bool lamps_are_lit(const lamps_t *lamps, const decision_t *decision);

/* Whether what they show follows the water. */
bool lamps_follow_water(const lamps_t *lamps);

/* PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity. */
void lamps_duties(const lamps_t *lamps, const decision_t *decision,
                  const led_settings_t *led, uint16_t duty[3]);

#endif
