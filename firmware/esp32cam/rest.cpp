#include "rest.h"

#include <Arduino.h>

enum {
    /* OV2640, as the driver numbers it: bank 1 (sensor), COM2, its standby. */
    NARROW_CONTROL = 0x109,
    NARROW_STANDBY = 0x10,
    /* OV3660 and OV5640: system control, software power down. */
    WIDE_CONTROL_0 = 0x3008,
    WIDE_STANDBY = 0x40,

    /* As fast as the clock of the peripherals, which must not change. */
    RESTING_MHZ = 80,
    WORKING_MHZ = 240,
};

bool sensor_rest(sensor_t *sensor, bool rest)
{
    const bool narrow = sensor->id.PID == OV2640_PID;
    const int reg = narrow ? NARROW_CONTROL : WIDE_CONTROL_0;
    const int mask = narrow ? NARROW_STANDBY : WIDE_STANDBY;
    return sensor->set_reg(sensor, reg, mask, rest ? mask : 0) >= 0;
}

void processor_rest(bool rest)
{
    setCpuFrequencyMhz(rest ? RESTING_MHZ : WORKING_MHZ);
}
