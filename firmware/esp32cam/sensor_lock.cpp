#include "sensor_lock.h"

enum {
    /* OV2640, as the driver numbers them: bank 0 (DSP), then the register. */
    WHITE_BALANCE_CONTROL = 0x0C7,
    WHITE_BALANCE_MANUAL = 0x40,
    WHITE_BALANCE_RED = 0x0CC, /* green and blue follow */
    /* OV3660 and OV5640: gains of 16 bits, in sixteenths of the OV2640's. */
    WIDE_CONTROL = 0x3406,
    WIDE_MANUAL = 0x01,
    WIDE_RED = 0x3400,
    /* Beyond it set_aec_value clamps without a word. */
    LONGEST_EXPOSURE = 1200,
};

/* What set_wb_mode writes for each preset: red, green, blue. */
static const uint8_t PRESET_GAINS[4][3] = {
    {0x5E, 0x41, 0x54}, /* sunny */
    {0x65, 0x41, 0x4F}, /* cloudy */
    {0x52, 0x41, 0x66}, /* office */
    {0x42, 0x3F, 0x71}, /* home */
};

bool sensor_takes_commands(const sensor_t *sensor)
{
    const uint16_t pid = sensor->id.PID;
    return pid == OV2640_PID || pid == OV3660_PID || pid == OV5640_PID;
}

/* What it means that commands were not taken. */
static sensor_result_t refusal(const sensor_t *sensor)
{
    return sensor_takes_commands(sensor) ? SENSOR_FAILED : SENSOR_DIFFERS;
}

bool sensor_white_balance_is_given(const camera_settings_t &settings)
{
    return settings.white_balance >= 1 && settings.white_balance <= 4;
}

bool sensor_values_are_given(const camera_settings_t &settings)
{
    return settings.exposure > 0 && settings.gain >= 0 &&
           sensor_white_balance_is_given(settings);
}

sensor_values_t sensor_read(sensor_t *sensor)
{
    /* The driver's status is what was last set; this asks the sensor, whose
     * automatic loops write the same registers. */
    sensor->init_status(sensor);
    sensor_values_t values;
    values.exposure = sensor->status.aec_value;
    values.gain = sensor->status.agc_gain;
    return values;
}

sensor_result_t sensor_release(sensor_t *sensor)
{
    int failures = 0;
    failures += sensor->set_exposure_ctrl(sensor, 1) != 0;
    failures += sensor->set_gain_ctrl(sensor, 1) != 0;
    failures += sensor->set_wb_mode(sensor, 0) != 0;
    failures += sensor->set_whitebal(sensor, 1) != 0;
    failures += sensor->set_awb_gain(sensor, 1) != 0;
    return failures == 0 ? SENSOR_OK : refusal(sensor);
}

static sensor_values_t choose(const camera_settings_t &settings,
                              const sensor_values_t &settled)
{
    sensor_values_t values = settled;
    if (settings.exposure > 0)
        values.exposure = settings.exposure;
    if (values.exposure > LONGEST_EXPOSURE)
        values.exposure = LONGEST_EXPOSURE;
    if (settings.gain >= 0)
        values.gain = static_cast<uint8_t>(settings.gain);
    return values;
}

/* Number of commands that the sensor did not take. */
static int lock_exposure_and_gain(sensor_t *sensor,
                                  const sensor_values_t &values)
{
    int failures = 0;
    /* The loops first, or they would write over the values. */
    failures += sensor->set_exposure_ctrl(sensor, 0) != 0;
    failures += sensor->set_aec_value(sensor, values.exposure) != 0;
    failures += sensor->set_aec2(sensor, 0) != 0;
    failures += sensor->set_gain_ctrl(sensor, 0) != 0;
    failures += sensor->set_agc_gain(sensor, values.gain) != 0;
    return failures;
}

static int lock_white_balance(sensor_t *sensor,
                              const camera_settings_t &settings)
{
    int failures = sensor->set_awb_gain(sensor, 1) != 0;
    if (sensor_white_balance_is_given(settings))
        failures += sensor->set_wb_mode(sensor, settings.white_balance) != 0;
    else
        failures += sensor->set_whitebal(sensor, 0) != 0;
    return failures;
}

/* Whether the bits of the mask read back as they should. */
static sensor_result_t check_register(sensor_t *sensor, int reg, int mask,
                                      int expected)
{
    const int value = sensor->get_reg(sensor, reg, mask);
    return value < 0           ? SENSOR_FAILED
           : value == expected ? SENSOR_OK
                               : SENSOR_DIFFERS;
}

static sensor_result_t check_white_balance(sensor_t *sensor,
                                           const camera_settings_t &settings)
{
    if (!sensor_white_balance_is_given(settings))
        return sensor->status.awb == 0 ? SENSOR_OK : SENSOR_DIFFERS;
    const bool wide = sensor->id.PID != OV2640_PID;
    const uint8_t *gains = PRESET_GAINS[settings.white_balance - 1];
    sensor_result_t result =
        wide ? check_register(sensor, WIDE_CONTROL, WIDE_MANUAL, WIDE_MANUAL)
             : check_register(sensor, WHITE_BALANCE_CONTROL,
                              WHITE_BALANCE_MANUAL, WHITE_BALANCE_MANUAL);
    for (int i = 0; i < 3 && result == SENSOR_OK; i++)
        result = wide ? check_register(sensor, WIDE_RED + 2 * i, 0xFFFF,
                                       16 * gains[i])
                      : check_register(sensor, WHITE_BALANCE_RED + i, 0xFF,
                                       gains[i]);
    return result;
}

sensor_result_t sensor_lock(sensor_t *sensor, const camera_settings_t &settings,
                            const sensor_values_t *known,
                            sensor_values_t *values)
{
    const sensor_values_t settled = sensor_read(sensor);
    const sensor_values_t wanted =
        choose(settings, known != nullptr ? *known : settled);
    const int failures = lock_exposure_and_gain(sensor, wanted) +
                         lock_white_balance(sensor, settings);
    if (failures > 0) {
        *values = sensor_read(sensor);
        return refusal(sensor);
    }
    *values = sensor_read(sensor);
    if (values->exposure != wanted.exposure || values->gain != wanted.gain ||
        sensor->status.aec != 0 || sensor->status.agc != 0)
        return SENSOR_DIFFERS;
    return check_white_balance(sensor, settings);
}
