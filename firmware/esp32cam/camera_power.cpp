#include "camera_power.h"

#include <driver/gpio.h>
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>

#include "pins.h"

enum {
    XCLK_HZ = 20000000,
    WAKE_MS = 10, /* from power to the first command */
};

static const gpio_num_t POWER_DOWN =
    static_cast<gpio_num_t>(PIN_CAMERA_POWER_DOWN);

static void set_power_down(uint32_t level)
{
    /* Level first: the pin shall not pulse while it becomes an output. */
    gpio_set_level(POWER_DOWN, level);
    gpio_set_direction(POWER_DOWN, GPIO_MODE_OUTPUT);
    gpio_set_level(POWER_DOWN, level);
}

static camera_config_t configuration()
{
    camera_config_t config = {};
    config.pin_pwdn = PIN_CAMERA_POWER_DOWN;
    config.pin_reset = PIN_CAMERA_RESET;
    config.pin_xclk = PIN_CAMERA_XCLK;
    config.pin_sccb_sda = PIN_CAMERA_SDA;
    config.pin_sccb_scl = PIN_CAMERA_SCL;
    config.pin_d7 = PIN_CAMERA_D7;
    config.pin_d6 = PIN_CAMERA_D6;
    config.pin_d5 = PIN_CAMERA_D5;
    config.pin_d4 = PIN_CAMERA_D4;
    config.pin_d3 = PIN_CAMERA_D3;
    config.pin_d2 = PIN_CAMERA_D2;
    config.pin_d1 = PIN_CAMERA_D1;
    config.pin_d0 = PIN_CAMERA_D0;
    config.pin_vsync = PIN_CAMERA_VSYNC;
    config.pin_href = PIN_CAMERA_HREF;
    config.pin_pclk = PIN_CAMERA_PCLK;
    config.xclk_freq_hz = XCLK_HZ;
    /* In the low-speed group, which the driver always uses for it: the LEDs
     * have the high-speed group to themselves. */
    config.ledc_timer = LEDC_TIMER_0;
    config.ledc_channel = LEDC_CHANNEL_0;
    config.pixel_format = PIXFORMAT_RGB565;
    config.frame_size = FRAMESIZE_QQVGA;
    /* With one buffer the next frame is always an old one. */
    config.fb_count = CAMERA_BUFFERS;
    config.grab_mode = CAMERA_GRAB_LATEST;
    /* Flash is written while PSRAM is out of reach. */
    config.fb_location = CAMERA_FB_IN_DRAM;
    return config;
}

esp_err_t camera_power_up()
{
    set_power_down(0);
    vTaskDelay(pdMS_TO_TICKS(WAKE_MS));
    const camera_config_t config = configuration();
    return esp_camera_init(&config);
}

void camera_power_down()
{
    esp_camera_deinit();
    set_power_down(1);
}
