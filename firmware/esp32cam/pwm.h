/* The LEDs: three PWM channels of ESP-IDF's LEDC, high-speed group.
 *
 * Only the colour task may call these: the driver's setters are not safe
 * between tasks. */
#ifndef PWM_H
#define PWM_H

#include <stdint.h>

/* Lets go of the pins.  Before the polarity is known there is no level that is
 * dark for sure, but an LED of either polarity is dark at an open pin. */
void pwm_release();

/* Takes the pins, LEDs dark. */
void pwm_start(bool common_anode);

/* Duties R, G, B as dock_led_duties gives them, polarity applied. */
void pwm_set(const uint16_t duty[3], bool common_anode);

#endif
