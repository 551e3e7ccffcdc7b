/* Hues, settings and duties of one LED. */
#ifndef LED_FIXTURE_H
#define LED_FIXTURE_H

#include <unity.h>

#include "led.h"

enum { RED = 0, GREEN = 512, BLUE = 1024, ORANGE = 128 /* 255, 128, 0 */ };

/* Linear light, nothing corrected, duty upright: what is not under test. */
static inline led_settings_t plain(void)
{
    return (led_settings_t){
        .matrix = {4096, 0, 0, 0, 4096, 0, 0, 0, 4096},
        .gamma = 0,
        .limit = 255,
        .common_anode = false,
    };
}

static inline void assert_duties(int red, int green, int blue, uint16_t hue,
                                 led_settings_t settings)
{
    uint16_t duty[3] = {9999, 9999, 9999};
    led_duties(duty, hue, &settings);
    TEST_ASSERT_EQUAL_UINT16(red, duty[0]);
    TEST_ASSERT_EQUAL_UINT16(green, duty[1]);
    TEST_ASSERT_EQUAL_UINT16(blue, duty[2]);
}

#endif
