/* A board that records what the firmware does to it, and fails on request.
 *
 * It defines the vendor's functions, so a suite includes it once. Time passes
 * only in the calls that wait. */
#ifndef BOARD_H
#define BOARD_H

#include <unity.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <string>
#include <vector>

#include <Arduino.h>
#include <driver/gpio.h>
#include <driver/ledc.h>
#include <driver/uart.h>
#include <esp_camera.h>
#include <esp_partition.h>
#include <esp_system.h>
#include <esp_task_wdt.h>
#include <esp_timer.h>
#include <freertos/FreeRTOS.h>
#include <freertos/queue.h>
#include <freertos/task.h>
#include <nvs.h>
#include <nvs_flash.h>

#include "../../firmware/esp32cam/core.h"

enum { FOREVER = -1, GRAB_TIMEOUT_MS = 4000 };

/* What esp_restart throws, which does not return. */
struct Restarted {};

/* What it throws where the loader hangs after it. */
struct Hung {};

/* What a flash write throws when the power fails in it. */
struct PowerLost {};

struct FakeSensor {
    sensor_t driver;
    /* What its registers hold. */
    int exposure, gain;
    bool auto_exposure, auto_gain, auto_white;
    int preset;
    int settled_exposure, settled_gain; /* what the automatic loops find */
    bool deaf;                          /* takes commands, keeps its values */
    std::string broken;                 /* the command that it does not take */
    int changed_gains; /* added to the white balance gains read back */
    int pid;           /* another sensor than the OV2640; 0: that */
    bool unmoved;      /* its picture does not follow its exposure */
    bool standby;      /* it gives no frames */
};

struct FakeBuffer {
    camera_fb_t driver;
    bool out;
};

/* NVS, and the first sector of the partition "spiffs". */
struct FakeFlash {
    esp_err_t init_error, open_error, get_error, set_error, commit_error;
    bool stored; /* NVS has the blob */
    std::string blob;
    bool torn; /* power lost in NVS leaves half a blob */
    int handles_open;
    bool without_sector; /* another partition table */
    esp_err_t erase_error, write_error;
    std::string sector;
    int power; /* writes until it fails; FOREVER: it does not */
};

struct FakeBoard {
    std::vector<std::string> log;
    int64_t us;

    std::deque<int> init_errors; /* of the next starts of the camera */
    int init_always;             /* of all later ones */
    int grabs_to_fail;
    int frame_ms;
    int64_t frame_age_us; /* of a frame when it is grabbed */
    bool camera_on;
    FakeBuffer buffers[2];
    camera_config_t camera_config;
    FakeSensor sensor;
    uint8_t pixels[160 * 120 * 2];

    int level[40], direction[40], pull[40];
    ledc_timer_config_t timer;
    ledc_channel_config_t channel[LEDC_CHANNEL_MAX];
    uint32_t duty[LEDC_CHANNEL_MAX], new_duty[LEDC_CHANNEL_MAX];

    FakeFlash flash;

    uart_config_t uart;
    std::string received, sent;
    uint32_t fifo; /* bytes taken in one go */
    bool wire_idle;

    uint32_t watchdog_ms;
    bool watchdog_panics, watchdog_watching, watchdog_started;
    int feeds;

    uint32_t cpu_mhz;

    std::function<void()> while_waiting;
    TaskFunction_t task;
    int task_core;
};

static FakeBoard board;

inline void note(const std::string &what)
{
    board.log.push_back(what);
}

inline void note(const std::string &what, long a)
{
    note(what + " " + std::to_string(a));
}

inline void note(const std::string &what, long a, long b)
{
    note(what + " " + std::to_string(a), b);
}

inline void pass_ms(int64_t ms)
{
    board.us += 1000 * ms;
}

inline int count_in_log(const std::string &what)
{
    int count = 0;
    for (const std::string &line : board.log)
        count += line == what;
    return count;
}

/* Where it stands first, from 0; -1: not there. */
inline int place_in_log(const std::string &what, int from = 0)
{
    for (size_t i = static_cast<size_t>(from); i < board.log.size(); i++)
        if (board.log[i] == what)
            return static_cast<int>(i);
    return -1;
}

/* These lines, in this order, with anything between them. */
inline void assert_in_order(const std::vector<std::string> &lines)
{
    int place = 0;
    for (const std::string &line : lines) {
        place = place_in_log(line, place);
        TEST_ASSERT_TRUE_MESSAGE(place >= 0, line.c_str());
        ++place;
    }
}

/* The driver is on and has a buffer to fill. */
inline bool camera_writes_memory()
{
    return board.camera_on && !(board.buffers[0].out && board.buffers[1].out);
}

extern "C" {

bool setCpuFrequencyMhz(uint32_t mhz)
{
    TEST_ASSERT_GREATER_OR_EQUAL_MESSAGE(80, mhz, "the LEDs' clock");
    TEST_ASSERT_FALSE_MESSAGE(camera_writes_memory(), "while it captures");
    note("cpu", mhz);
    board.cpu_mhz = mhz;
    return true;
}

int64_t esp_timer_get_time(void)
{
    return board.us;
}

/* Resets no peripheral: where the camera's DMA runs it goes on writing, over
 * the memory of the loader. */
void esp_restart(void)
{
    note("esp_restart");
    if (camera_writes_memory())
        throw Hung();
    throw Restarted();
}

esp_reset_reason_t esp_reset_reason(void)
{
    return ESP_RST_BROWNOUT;
}

esp_err_t gpio_set_level(gpio_num_t pin, uint32_t level)
{
    note("gpio_set_level", pin, static_cast<long>(level));
    board.level[pin] = static_cast<int>(level);
    return ESP_OK;
}

esp_err_t gpio_set_direction(gpio_num_t pin, gpio_mode_t mode)
{
    note("gpio_set_direction", pin, mode);
    board.direction[pin] = mode;
    return ESP_OK;
}

esp_err_t gpio_set_pull_mode(gpio_num_t pin, gpio_pull_mode_t pull)
{
    board.pull[pin] = pull;
    return ESP_OK;
}

esp_err_t ledc_timer_config(const ledc_timer_config_t *timer)
{
    note("ledc_timer_config");
    board.timer = *timer;
    return ESP_OK;
}

esp_err_t ledc_channel_config(const ledc_channel_config_t *channel)
{
    note("ledc_channel_config", channel->channel);
    board.channel[channel->channel] = *channel;
    board.duty[channel->channel] = channel->duty;
    return ESP_OK;
}

esp_err_t ledc_set_duty(ledc_mode_t, ledc_channel_t channel, uint32_t duty)
{
    note("ledc_set_duty", channel, static_cast<long>(duty));
    board.new_duty[channel] = duty;
    return ESP_OK;
}

esp_err_t ledc_update_duty(ledc_mode_t, ledc_channel_t channel)
{
    board.duty[channel] = board.new_duty[channel];
    return ESP_OK;
}

esp_err_t uart_driver_install(uart_port_t, int receive_bytes, int, int,
                              QueueHandle_t *, int)
{
    note("uart_driver_install");
    /* The driver refuses a ring that is no longer than the hardware's FIFO. */
    TEST_ASSERT_GREATER_THAN(128, receive_bytes);
    return ESP_OK;
}

esp_err_t uart_param_config(uart_port_t, const uart_config_t *config)
{
    board.uart = *config;
    return ESP_OK;
}

esp_err_t uart_set_pin(uart_port_t, int tx, int rx, int, int)
{
    note("uart_set_pin", tx, rx);
    return ESP_OK;
}

int uart_read_bytes(uart_port_t, void *buffer, uint32_t length, TickType_t wait)
{
    TEST_ASSERT_EQUAL_UINT32(0, wait);
    const size_t n =
        board.received.size() < length ? board.received.size() : length;
    memcpy(buffer, board.received.data(), n);
    board.received.erase(0, n);
    return static_cast<int>(n);
}

int uart_tx_chars(uart_port_t, const char *buffer, uint32_t length)
{
    const uint32_t n = length < board.fifo ? length : board.fifo;
    board.sent.append(buffer, n);
    return static_cast<int>(n);
}

esp_err_t uart_wait_tx_done(uart_port_t, TickType_t wait)
{
    TEST_ASSERT_EQUAL_UINT32(0, wait);
    return board.wire_idle ? ESP_OK : ESP_ERR_TIMEOUT;
}

#if ESP_IDF_VERSION_MAJOR >= 5
inline void take_watchdog(const esp_task_wdt_config_t *config)
{
    board.watchdog_ms = config->timeout_ms;
    board.watchdog_panics = config->trigger_panic;
}

esp_err_t esp_task_wdt_init(const esp_task_wdt_config_t *config)
{
    note("esp_task_wdt_init");
    if (board.watchdog_started)
        return ESP_ERR_INVALID_STATE;
    take_watchdog(config);
    board.watchdog_started = true;
    return ESP_OK;
}

esp_err_t esp_task_wdt_reconfigure(const esp_task_wdt_config_t *config)
{
    note("esp_task_wdt_reconfigure");
    if (!board.watchdog_started)
        return ESP_ERR_INVALID_STATE;
    TEST_ASSERT_EQUAL_UINT32(1, config->idle_core_mask);
    take_watchdog(config);
    return ESP_OK;
}
#else
esp_err_t esp_task_wdt_init(uint32_t timeout, bool panic)
{
    note("esp_task_wdt_init");
    board.watchdog_ms = 1000 * timeout;
    board.watchdog_panics = panic;
    return ESP_OK;
}
#endif

esp_err_t esp_task_wdt_add(TaskHandle_t task)
{
    note("esp_task_wdt_add");
    board.watchdog_watching = task == nullptr;
    return ESP_OK;
}

esp_err_t esp_task_wdt_reset(void)
{
    ++board.feeds;
    return ESP_OK;
}

} /* extern "C" */

EspClass ESP;

uint64_t EspClass::getEfuseMac()
{
    return UINT64_C(0x240AC4123456);
}

/* Unity leaves a test that failed by a jump over its destructors. What leaks is
 * the suite's: the firmware's shell allocates nothing. */
extern "C" const char *__asan_default_options()
{
    return "detect_leaks=0";
}

#include "fake_camera.h"
#include "fake_flash.h"
#include "fake_rtos.h"

/* A board that nobody has touched, with everything in order. */
inline void board_reset()
{
    board = FakeBoard();
    board.flash = blank_flash();
    board.frame_ms = 80;
    board.frame_age_us = 40000;
    board.sensor.settled_exposure = 300;
    board.sensor.settled_gain = 5;
    board.cpu_mhz = 240;
    board.fifo = 128;
    board.wire_idle = true;
    board.watchdog_started = true;
    /* Not at 0: a board that starts has run its loader. */
    board.us = 500000;
}

#endif
