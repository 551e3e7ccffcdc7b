#include "pwm.h"

#include <driver/gpio.h>
#include <driver/ledc.h>

#include "core.h"
#include "pins.h"

enum {
    CHANNELS = 3,
    /* Fast enough for a rolling shutter to see many periods.  80 MHz / 2^12 is
     * 19,531 Hz; a little less, or the divider comes out below 1. */
    FREQUENCY_HZ = 19500,
};

static const int PINS[CHANNELS] = {PIN_RED, PIN_GREEN, PIN_BLUE};

struct pwm_state_t {
    uint32_t light[CHANNELS]; /* 0: dark, LED_FULL: solid on */
    bool inverted;
};

static pwm_state_t state;

void pwm_release()
{
    for (int i = 0; i < CHANNELS; i++) {
        const gpio_num_t pin = static_cast<gpio_num_t>(PINS[i]);
        gpio_set_direction(pin, GPIO_MODE_INPUT);
        gpio_set_pull_mode(pin, GPIO_FLOATING);
    }
}

static void configure_timer()
{
    ledc_timer_config_t timer = {};
    timer.speed_mode = LEDC_HIGH_SPEED_MODE;
    timer.duty_resolution = static_cast<ledc_timer_bit_t>(METHOD_PWM_BITS);
    timer.timer_num = LEDC_TIMER_1;
    timer.freq_hz = FREQUENCY_HZ;
    timer.clk_cfg = LEDC_USE_APB_CLK;
    ledc_timer_config(&timer);
}

/* Inverted in the hardware, so that the pin idles dark as well. */
static void configure_channels()
{
    for (int i = 0; i < CHANNELS; i++) {
        ledc_channel_config_t channel = {};
        channel.gpio_num = PINS[i];
        channel.speed_mode = LEDC_HIGH_SPEED_MODE;
        channel.channel = static_cast<ledc_channel_t>(i);
        channel.timer_sel = LEDC_TIMER_1;
        channel.duty = state.light[i];
        channel.hpoint = 0;
        channel.flags.output_invert = state.inverted ? 1 : 0;
        /* ESP-IDF 4.4 makes the pin an output before it connects the PWM: for
         * that moment the dark level. */
        gpio_set_level(static_cast<gpio_num_t>(PINS[i]), state.inverted);
        ledc_channel_config(&channel);
    }
}

void pwm_start(bool common_anode)
{
    state = pwm_state_t();
    state.inverted = common_anode;
    configure_timer();
    configure_channels();
}

void pwm_set(const uint16_t duty[3], bool common_anode)
{
    uint32_t light[CHANNELS];
    for (int i = 0; i < CHANNELS; i++)
        light[i] = common_anode ? LED_FULL - duty[i] : duty[i];
    if (common_anode != state.inverted) {
        state.inverted = common_anode;
        for (int i = 0; i < CHANNELS; i++)
            state.light[i] = light[i];
        configure_channels();
        return;
    }
    for (int i = 0; i < CHANNELS; i++) {
        if (light[i] == state.light[i])
            continue;
        const ledc_channel_t channel = static_cast<ledc_channel_t>(i);
        state.light[i] = light[i];
        ledc_set_duty(LEDC_HIGH_SPEED_MODE, channel, light[i]);
        ledc_update_duty(LEDC_HIGH_SPEED_MODE, channel);
    }
}
