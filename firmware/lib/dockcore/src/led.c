#include "led.h"

#include "hsv.h"

static int64_t clamp(int64_t value, int64_t least, int64_t most)
{
    return value < least ? least : value > most ? most : value;
}

uint16_t led_light(uint8_t code, uint8_t gamma)
{
    if (gamma == 0)
        return (uint16_t)(UINT16_MAX / 255 * code);
    return METHOD_GAMMA[256 * (gamma - 1) + code];
}

/* Light 0..65535 after the matrix row. */
static uint32_t mix(const int16_t row[3], const uint16_t light[3])
{
    int64_t sum = METHOD_MATRIX_UNIT / 2;
    for (int i = 0; i < 3; i++)
        sum += (int64_t)row[i] * light[i];
    return (uint32_t)clamp(sum / METHOD_MATRIX_UNIT, 0, UINT16_MAX);
}

/* Duty of linear light 0..65535, as bright as the limit allows. */
static uint16_t duty_of(uint32_t light, const led_settings_t *settings)
{
    const uint32_t limited = (light * settings->limit + 127) / 255;
    const uint32_t duty = (limited * LED_FULL + UINT16_MAX / 2) / UINT16_MAX;
    return (uint16_t)(settings->common_anode ? LED_FULL - duty : duty);
}

led_settings_t led_dimmed(const led_settings_t *settings, uint8_t value)
{
    led_settings_t dimmed = *settings;
    if (settings->dark_limit < settings->limit) {
        const uint32_t range = (uint32_t)settings->limit - settings->dark_limit;
        dimmed.limit =
            (uint8_t)(settings->dark_limit + (range * value + 127) / 255);
    }
    return dimmed;
}

void led_duties(uint16_t duty[3], uint16_t hue, const led_settings_t *settings)
{
    const rgb_t pure = rgb_from_hsv(hue, 255, 255);
    const uint8_t code[3] = {pure.red, pure.green, pure.blue};
    uint16_t light[3];
    for (int i = 0; i < 3; i++) {
        const int64_t shifted = clamp(code[i] + settings->offset[i], 0, 255);
        light[i] = led_light((uint8_t)shifted, settings->gamma);
    }
    for (int i = 0; i < 3; i++)
        duty[i] = duty_of(mix(settings->matrix + 3 * i, light), settings);
}

void led_raw_duties(uint16_t duty[3], const uint8_t light[3],
                    const led_settings_t *settings)
{
    for (int i = 0; i < 3; i++)
        duty[i] = duty_of(light[i] * UINT32_C(257), settings);
}

void led_dark(uint16_t duty[3], const led_settings_t *settings)
{
    for (int i = 0; i < 3; i++)
        duty[i] = duty_of(0, settings);
}
