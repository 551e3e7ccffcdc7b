#include "lamps.h"

#include <string.h>

#include "messages.h"

_Static_assert((int)DOCK_LED_AUTO == 0 && (int)DOCK_LED_HUE == 1,
               "LED_MODE's values are DOCK_LED's first two");

void lamps_init(lamps_t *lamps, const dock_settings_t *settings)
{
    memset(lamps, 0, sizeof *lamps);
    lamps->mode = settings->led_mode;
    lamps->hue = settings->led_hue;
}

void lamps_follow(lamps_t *lamps, const dock_settings_t *before,
                  const dock_settings_t *now)
{
    if (before->led_mode == now->led_mode && before->led_hue == now->led_hue)
        return;
    lamps->mode = now->led_mode;
    lamps->hue = now->led_hue;
}

void lamps_show_marker(lamps_t *lamps)
{
    lamps->mode = DOCK_LED_AUTO;
}

void lamps_show_hue(lamps_t *lamps, uint16_t hue)
{
    lamps->mode = DOCK_LED_HUE;
    lamps->hue = hue;
}

void lamps_show_raw(lamps_t *lamps, const uint8_t rgb[3])
{
    lamps->mode = DOCK_LED_RAW;
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
