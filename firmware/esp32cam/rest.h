/* What saves power between two decisions: the sensor in standby, the processor
 * slow.  The LEDs and the link go on. */
#ifndef REST_H
#define REST_H

#include <esp_camera.h>

/* Standby of a sensor that takes commands (sensor_lock.h), by a register, in
 * which by the data sheet all others keep what they hold, exposure and gain
 * included; the power-down pin may cut the sensor's supply, by the board. False
 * where it does not answer. */
bool sensor_rest(sensor_t *sensor, bool rest);

/* 80 or 240 MHz.  While it changes, for a fraction of a millisecond, LEDs and
 * link are off their clock: a byte may be lost, which the link's checksum
 * finds. */
void processor_rest(bool rest);

#endif
