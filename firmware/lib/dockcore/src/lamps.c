#include "lamps.h"

#include <string.h>

#include "messages.h"

_Static_assert((int)DOCK_LED_AUTO == 0 && (int)DOCK_LED_HUE == 1,
               "LED_MODE's values are DOCK_LED's first two");

void lamps_follow(lamps_t *lamps, const dock_settings_t *settings)
{
    lamps->mode = settings->led_mode;
    lamps->hue = settings->led_hue;
    lamps->testing = false;
}

static void test(lamps_t *lamps, uint8_t mode, uint32_t now_ms)
{
    lamps->mode = mode;
    lamps->testing = true;
    lamps->tested_ms = now_ms;
}

void lamps_test_marker(lamps_t *lamps, uint32_t now_ms)
{
    test(lamps, DOCK_LED_AUTO, now_ms);
}

void lamps_test_hue(lamps_t *lamps, uint16_t hue, uint32_t now_ms)
{
    test(lamps, DOCK_LED_HUE, now_ms);
    lamps->hue = hue;
}

void lamps_test_raw(lamps_t *lamps, const uint8_t rgb[3], uint32_t now_ms)
{
    test(lamps, DOCK_LED_RAW, now_ms);
    memcpy(lamps->raw, rgb, sizeof lamps->raw);
}

void lamps_turn(lamps_t *lamps, uint32_t now_ms)
{
    if (!lamps->begun)
        lamps->since_ms = now_ms;
    lamps->begun = true;
    if (now_ms - lamps->since_ms >= DECISION_WAIT_MS)
        lamps->overdue = true;
}

bool lamps_are_lit(const lamps_t *lamps, const decision_t *decision)
{
    return lamps->mode != DOCK_LED_AUTO || decision->decided || lamps->overdue;
}

bool lamps_follow_water(const lamps_t *lamps)
{
    return lamps->mode == DOCK_LED_AUTO;
}

/* As bright as the limit allows where the water is not known. */
static void show_marker(const decision_t *decision, const led_settings_t *led,
                        uint16_t duty[3])
{
    const uint8_t value = decision->decided ? decision->water_value : 255;
    const led_settings_t dimmed = led_dimmed(led, value);
    led_duties(duty, decision->steady.shown, &dimmed);
}

bool lamps_expire(lamps_t *lamps, const dock_settings_t *settings,
                  uint32_t now_ms)
{
    if (!lamps->testing || now_ms - lamps->tested_ms < LAMPS_TEST_MS)
        return false;
    lamps_follow(lamps, settings);
    return true;
}

void lamps_duties(const lamps_t *lamps, const decision_t *decision,
                  const led_settings_t *led, uint16_t duty[3])
{
    if (lamps->mode == DOCK_LED_RAW)
        led_raw_duties(duty, lamps->raw, led);
    else if (lamps->mode == DOCK_LED_HUE)
        led_duties(duty, lamps->hue, led);
    else if (lamps_are_lit(lamps, decision))
        show_marker(decision, led, duty);
    else
        led_dark(duty, led);
}
