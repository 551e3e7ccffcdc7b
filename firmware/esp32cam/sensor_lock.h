/* Exposure, gain and white balance of the sensor: automatic, or locked.
 *
 * Automatic white balance removes the very colour that is measured, and the
 * dock's own LEDs would drive it. */
#ifndef SENSOR_LOCK_H
#define SENSOR_LOCK_H

#include <esp_camera.h>

#include "core.h"

struct sensor_values_t {
    uint16_t exposure; /* sensor lines */
    uint8_t gain;      /* index of the driver's table, 0..30 */
};

enum sensor_result_t {
    SENSOR_OK,
    SENSOR_DIFFERS, /* it reads back something else, or knows no such command */
    SENSOR_FAILED,  /* it does not answer */
};

/* True for a sensor whose driver has every command that a lock needs: OV2640,
 * OV3660, OV5640.  One that refuses a command does not answer.  The driver of
 * any other says no to all of them, and the sensor stays automatic. */
bool sensor_takes_commands(const sensor_t *sensor);

/* True where the settings name every value to lock at. */
bool sensor_values_are_given(const camera_settings_t &settings);

/* True where the white balance can be set again after the sensor lost power:
 * the gains that it settled on cannot be read. */
bool sensor_white_balance_is_given(const camera_settings_t &settings);

/* Everything automatic again. */
sensor_result_t sensor_release(sensor_t *sensor);

/* Locks at what the settings say; where they say "as settled", at `known`, or
 * if that is NULL at what the sensor is using now.  *values is what it reads
 * back afterwards. */
sensor_result_t sensor_lock(sensor_t *sensor, const camera_settings_t &settings,
                            const sensor_values_t *known,
                            sensor_values_t *values);

/* Exposure and gain that the sensor is using now. */
sensor_values_t sensor_read(sensor_t *sensor);

#endif
