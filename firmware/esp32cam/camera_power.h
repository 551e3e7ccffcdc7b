/* The sensor's supply, by its power-down pin, and the driver's start. */
#ifndef CAMERA_POWER_H
#define CAMERA_POWER_H

#include <esp_camera.h>

/* One to fill while the other is in use. */
enum { CAMERA_BUFFERS = 2 };

/* Powers the sensor and starts the driver, for QQVGA in RGB565: what dockcore's
 * fast path reads.  Anything but ESP_OK: no camera,
 * and the driver is stopped. */
esp_err_t camera_power_up();

/* Stops the driver, whatever state it is in, and switches the sensor off. All
 * frames must have been returned. */
void camera_power_down();

#endif
