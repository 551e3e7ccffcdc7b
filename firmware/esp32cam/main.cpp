/* The dock's firmware: what starts in which order. */
#include <Arduino.h>
#include <esp_system.h>
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>
#include <string.h>

#include "core.h"
#include "last_hue.h"
#include "loop.h"
#include "mailbox.h"
#include "port.h"
#include "pwm.h"
#include "storage.h"
#include "watchdog.h"

/* Arduino's loop() is the colour task.  The driver's own task is on core 0; its
 * interrupts are on the core whose task starts it, which is this one. */
#if defined(ARDUINO_RUNNING_CORE) && ARDUINO_RUNNING_CORE != 1
#error "the colour task belongs on core 1"
#endif

#ifndef GIT_HASH
#define GIT_HASH "unknown"
#endif

enum {
    COLOUR_CORE = 1,
    CAMERA_PRIORITY = 1, /* as loop(), which it only ever waits for */
    CAMERA_STACK = 8192, /* bytes; the driver's start needs half of it */
    CAMERA_SLEEP_MS = 10,
};

static dock_t dock;
static Loop colour(&dock);
static Camera camera;
static StackType_t camera_stack[CAMERA_STACK];
static StaticTask_t camera_task;
alignas(4) static uint8_t image[DOCK_IMAGE_BYTES];

/* One turn of the camera's task. */
static void camera_turn()
{
    const camera_report_t report = camera.step(mailbox_ordered());
    if (report.event == CAMERA_NOTHING) {
        vTaskDelay(pdMS_TO_TICKS(CAMERA_SLEEP_MS));
        return;
    }
    mailbox_report(report);
    camera.release(report);
}

static void run_camera(void *)
{
    for (;;)
        camera_turn();
}

static void tell_board(dock_stored_t stored)
{
    static const char hash[] = GIT_HASH;
    dock_board_t board = {};
    board.reset_reason = static_cast<uint8_t>(esp_reset_reason());
    board.settings = stored;
    for (size_t i = 0; i < sizeof board.git_hash && hash[i] != '\0'; i++)
        board.git_hash[i] = static_cast<uint8_t>(hash[i]);
    board.buffer = image;
    board.capacity = sizeof image;
    board.uid = ESP.getEfuseMac();
    dock_set_board(&dock, &board);
}

void setup()
{
    /* Dark before anything that takes time; and dark still when the settings
     * have told which way round that is. */
    pwm_release();
    dock_settings_t settings;
    const dock_stored_t stored = storage_load(&settings);
    pwm_start(settings.led.common_anode);
    port_start(settings.link_baud);

    dock_init(&dock, &settings);
    tell_board(stored);
    dock_set_last_hue(&dock, last_hue());

    /* The camera while memory is in one piece: it needs 32 KB of it at once. */
    camera_order_t order = {};
    order.settings = settings.camera;
    order.serial = 1;
    colour.begin(order);
    mailbox_start(order);
    xTaskCreateStaticPinnedToCore(run_camera, "camera", CAMERA_STACK, nullptr,
                                  CAMERA_PRIORITY, camera_stack, &camera_task,
                                  COLOUR_CORE);
    /* Last: nothing above can feed it. */
    watchdog_start();
}

void loop()
{
    colour.turn();
}
