/* The camera and its driver, of board.h. */
#ifndef FAKE_CAMERA_H
#define FAKE_CAMERA_H

/* In esp32-camera's gc2145.c every command is one that returns -1. */
inline bool sensor_is_dumb()
{
    return board.sensor.pid == GC2145_PID;
}

inline int sensor_takes(const char *command, long value)
{
    note(command, value);
    return sensor_is_dumb() || board.sensor.broken == command ? -1 : 0;
}

inline int fake_init_status(sensor_t *sensor)
{
    FakeSensor &fake = board.sensor;
    note("init_status");
    if (sensor_is_dumb()) {
        sensor->status = camera_status_t();
        return 0;
    }
    if (fake.auto_exposure)
        fake.exposure = fake.settled_exposure;
    if (fake.auto_gain)
        fake.gain = fake.settled_gain;
    sensor->status.aec_value = static_cast<uint16_t>(fake.exposure);
    sensor->status.agc_gain = static_cast<uint8_t>(fake.gain);
    sensor->status.aec = fake.auto_exposure;
    sensor->status.agc = fake.auto_gain;
    sensor->status.awb = fake.auto_white;
    return 0;
}

inline int fake_set_whitebal(sensor_t *, int enable)
{
    board.sensor.auto_white = enable != 0;
    return sensor_takes("set_whitebal", enable);
}

inline int fake_set_gain_ctrl(sensor_t *, int enable)
{
    if (!board.sensor.deaf)
        board.sensor.auto_gain = enable != 0;
    return sensor_takes("set_gain_ctrl", enable);
}

inline int fake_set_exposure_ctrl(sensor_t *, int enable)
{
    if (!board.sensor.deaf)
        board.sensor.auto_exposure = enable != 0;
    return sensor_takes("set_exposure_ctrl", enable);
}

inline int fake_set_aec2(sensor_t *, int enable)
{
    return sensor_takes("set_aec2", enable);
}

inline int fake_set_awb_gain(sensor_t *, int enable)
{
    return sensor_takes("set_awb_gain", enable);
}

inline int fake_set_agc_gain(sensor_t *, int gain)
{
    if (!board.sensor.deaf)
        board.sensor.gain = gain;
    return sensor_takes("set_agc_gain", gain);
}

inline int fake_set_aec_value(sensor_t *, int value)
{
    if (!board.sensor.deaf)
        board.sensor.exposure = value > 1200 ? 1200 : value;
    return sensor_takes("set_aec_value", value);
}

inline int fake_set_wb_mode(sensor_t *, int mode)
{
    board.sensor.preset = mode;
    return sensor_takes("set_wb_mode", mode);
}

inline int fake_get_reg(sensor_t *, int reg, int mask)
{
    /* Of esp32-camera's sensors/private_include/ov2640_settings.h. */
    static const int gains[5][3] = {{0x80, 0x40, 0x40},
                                    {0x5E, 0x41, 0x54},
                                    {0x65, 0x41, 0x4F},
                                    {0x52, 0x41, 0x66},
                                    {0x42, 0x3F, 0x71}};
    if (board.sensor.broken == "get_reg")
        return -1;
    if (board.sensor.pid != 0) { /* OV3660 and OV5640 */
        if (reg == 0x3406)
            return (board.sensor.preset > 0 ? 1 : 0) & mask;
        TEST_ASSERT_EQUAL_HEX(0x3400, reg & ~6);
        const int wide = gains[board.sensor.preset][(reg - 0x3400) / 2] << 4;
        return (wide + board.sensor.changed_gains) & mask;
    }
    if (reg == 0xC7)
        return (board.sensor.preset > 0 ? 0x40 : 0) & mask;
    TEST_ASSERT_INT_WITHIN(1, 0xCD, reg);
    const int gain = gains[board.sensor.preset][reg - 0xCC];
    return (gain + board.sensor.changed_gains) & mask;
}

inline int fake_set_reg(sensor_t *, int reg, int mask, int value)
{
    const bool narrow = board.sensor.pid == 0;
    TEST_ASSERT_EQUAL_HEX(narrow ? 0x109 : 0x3008, reg);
    TEST_ASSERT_EQUAL_HEX(narrow ? 0x10 : 0x40, mask);
    board.sensor.standby = value != 0;
    return sensor_takes("standby", board.sensor.standby);
}

/* What power and reset leave it with. */
inline void sensor_power_on()
{
    FakeSensor &fake = board.sensor;
    fake.exposure = 100;
    fake.gain = 0;
    fake.auto_exposure = fake.auto_gain = fake.auto_white = true;
    fake.preset = 0;
    fake.driver = sensor_t();
    fake.driver.id.PID =
        static_cast<uint16_t>(fake.pid != 0 ? fake.pid : OV2640_PID);
    fake.driver.init_status = fake_init_status;
    fake.driver.set_whitebal = fake_set_whitebal;
    fake.driver.set_gain_ctrl = fake_set_gain_ctrl;
    fake.driver.set_exposure_ctrl = fake_set_exposure_ctrl;
    fake.driver.set_aec2 = fake_set_aec2;
    fake.driver.set_awb_gain = fake_set_awb_gain;
    fake.driver.set_agc_gain = fake_set_agc_gain;
    fake.driver.set_aec_value = fake_set_aec_value;
    fake.driver.set_wb_mode = fake_set_wb_mode;
    fake.driver.get_reg = fake_get_reg;
    fake.driver.set_reg = fake_set_reg;
    fake.standby = false;
}

extern "C" {

esp_err_t esp_camera_init(const camera_config_t *config)
{
    note("esp_camera_init");
    board.camera_config = *config;
    TEST_ASSERT_FALSE_MESSAGE(board.camera_on, "started twice");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, board.level[32], "without power");
    int error = board.init_always;
    if (!board.init_errors.empty()) {
        error = board.init_errors.front();
        board.init_errors.pop_front();
    }
    if (error != ESP_OK)
        return error;
    board.camera_on = true;
    sensor_power_on();
    return ESP_OK;
}

esp_err_t esp_camera_deinit(void)
{
    note("esp_camera_deinit");
    for (const FakeBuffer &buffer : board.buffers)
        TEST_ASSERT_FALSE_MESSAGE(buffer.out, "a frame is still in use");
    const bool was_on = board.camera_on;
    board.camera_on = false;
    return was_on ? ESP_OK : ESP_ERR_INVALID_STATE;
}

/* The painted picture is that of the settled exposure; at another one its light
 * is as much more or less, and a pixel its 2.2th root. */
inline uint8_t *exposed_pixels()
{
    static uint8_t exposed[sizeof board.pixels];
    const FakeSensor &fake = board.sensor;
    if (fake.auto_exposure || fake.unmoved || sensor_is_dumb() ||
        fake.exposure == fake.settled_exposure)
        return board.pixels;
    const double factor =
        pow(1.0 * fake.exposure / fake.settled_exposure, 1 / 2.2);
    for (size_t i = 0; i < sizeof exposed; i += 2) {
        const int word = board.pixels[i] << 8 | board.pixels[i + 1];
        const int red = std::min(31, static_cast<int>((word >> 11) * factor));
        const int green =
            std::min(63, static_cast<int>((word >> 5 & 63) * factor));
        const int blue = std::min(31, static_cast<int>((word & 31) * factor));
        const int lit = red << 11 | green << 5 | blue;
        exposed[i] = static_cast<uint8_t>(lit >> 8);
        exposed[i + 1] = static_cast<uint8_t>(lit);
    }
    return exposed;
}

camera_fb_t *esp_camera_fb_get(void)
{
    TEST_ASSERT_TRUE_MESSAGE(board.camera_on, "no driver");
    if (board.grabs_to_fail != 0 || board.sensor.standby) {
        if (board.grabs_to_fail > 0)
            --board.grabs_to_fail;
        pass_ms(GRAB_TIMEOUT_MS);
        return nullptr;
    }
    pass_ms(board.frame_ms);
    for (FakeBuffer &buffer : board.buffers) {
        if (buffer.out)
            continue;
        buffer.out = true;
        camera_fb_t &frame = buffer.driver;
        frame = camera_fb_t();
        frame.buf = exposed_pixels();
        frame.len = sizeof board.pixels;
        frame.width = 160;
        frame.height = 120;
        frame.format = PIXFORMAT_RGB565;
        const int64_t began = board.us - board.frame_age_us;
        frame.timestamp.tv_sec = static_cast<time_t>(began / 1000000);
        frame.timestamp.tv_usec = static_cast<suseconds_t>(began % 1000000);
        return &frame;
    }
    TEST_FAIL_MESSAGE("more frames out than there are buffers");
    return nullptr;
}

void esp_camera_fb_return(camera_fb_t *frame)
{
    for (FakeBuffer &buffer : board.buffers)
        if (&buffer.driver == frame) {
            TEST_ASSERT_TRUE_MESSAGE(buffer.out, "returned twice");
            buffer.out = false;
        }
}

sensor_t *esp_camera_sensor_get(void)
{
    return board.camera_on ? &board.sensor.driver : nullptr;
}

} /* extern "C" */

inline int frames_out()
{
    return board.buffers[0].out + board.buffers[1].out;
}

#endif
