/* From a marker hue to the PWM duties of one RGB LED. */
#ifndef LED_H
#define LED_H

#include <stdbool.h>
#include <stdint.h>

#include "method.h"

#define LED_FULL \
    (1u << METHOD_PWM_BITS) /* duty of a channel that is solid on */

typedef struct {
    int16_t offset[3]; /* added to the 8-bit colour, R G B, -255..255 (paper) */
    int16_t
        matrix[9]; /* rows R G B, on linear light, METHOD_MATRIX_UNIT = 1.0 */
    uint8_t gamma; /* index of the decoding exponent, < METHOD_GAMMA_COUNT */
    uint8_t limit; /* brightness, 255: all */
    bool common_anode;  /* the pin pulls the LED's cathode low: duty inverted */
    uint8_t dark_limit; /* `limit` where the water is black; see led_dimmed */
} led_settings_t;

/* The same settings with the limit for water of this HSV value, 0..255: from
 * dark_limit at 0 to limit at 255, or limit where dark_limit is no less.  The
 * value is gamma-coded, so that half the value is a fifth of the light: the
 * LEDs are dimmed later than the water is. */
led_settings_t led_dimmed(const led_settings_t *settings, uint8_t value);

/* Linear light 0..65535 of a gamma-coded value; gamma as in the settings, of
 * which 0 is the exponent 1: light in proportion to the value. */
uint16_t led_light(uint8_t code, uint8_t gamma);

/* Duties 0..LED_FULL of a pure colour: offset, gamma decoding, 3 x 3 matrix,
 * limit, polarity. */
void led_duties(uint16_t duty[3], uint16_t hue, const led_settings_t *settings);

/* Duties of 8-bit light levels R, G, B: limit and polarity only, for testing
 * one channel at a time. */
void led_raw_duties(uint16_t duty[3], const uint8_t light[3],
                    const led_settings_t *settings);

/* Duties that leave the LED dark. */
void led_dark(uint16_t duty[3], const led_settings_t *settings);

#endif
