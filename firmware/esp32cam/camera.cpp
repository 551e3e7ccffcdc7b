#include "camera.h"

#include "clock.h"
#include "rest.h"

camera_report_t Camera::report(camera_event_t event, camera_fb_t *frame) const
{
    camera_report_t report = {};
    report.event = event;
    report.frame = frame;
    report.camera.exposure = values.exposure;
    report.camera.gain = values.gain;
    report.camera.locked = locked;
    report.camera.proven = locked && proof == LOCK_PROVEN;
    report.camera.sensor = sensor != nullptr ? sensor->id.PID : 0;
    return report;
}

camera_report_t Camera::report_no_camera()
{
    if (!fault_due && clock_ms() - fault_ms < CAMERA_FAULT_MS)
        return report(CAMERA_NOTHING, nullptr);
    fault_due = false;
    fault_ms = clock_ms();
    return report(CAMERA_FAULT, nullptr);
}

camera_report_t Camera::step(const camera_order_t &order)
{
    if (order.pause) {
        pause();
        return report(CAMERA_PAUSED, nullptr);
    }
    if (may_rest(order)) {
        rest();
        return report(CAMERA_NOTHING, nullptr);
    }
    wake();
    resume();
    if (state == WITHOUT) {
        if (backoff.due(clock_ms()))
            start(order);
    } else if (order.serial != serial) {
        apply(order);
    } else if (state == RUNNING) {
        look_after_sensor();
    }
    if (state == WITHOUT)
        return report_no_camera();

    camera_fb_t *frame = esp_camera_fb_get();
    if (frame == nullptr) {
        fail();
    } else if (state == RUNNING && skip == 0 && !is_stale(*frame)) {
        backoff.succeed();
        delivered_ms = clock_ms();
        return report(CAMERA_FRAME, frame);
    } else {
        drop(frame);
    }
    return state == WITHOUT ? report_no_camera()
                            : report(CAMERA_NOTHING, nullptr);
}

int64_t camera_began_us(const camera_fb_t &frame)
{
    return int64_t{1000000} * frame.timestamp.tv_sec + frame.timestamp.tv_usec;
}

void Camera::release(const camera_report_t &report)
{
    if (report.frame != nullptr)
        esp_camera_fb_return(report.frame);
}

bool Camera::is_stale(const camera_fb_t &frame) const
{
    return camera_began_us(frame) < fresh_us;
}

/* A frame that is not for the dock. */
void Camera::drop(camera_fb_t *frame)
{
    const bool stale = is_stale(*frame);
    const bool counts = !stale && skip == 0;
    const uint32_t brightness =
        counts && state == CHECKING ? frame_brightness(*frame) : 0;
    esp_camera_fb_return(frame);
    if (stale)
        return;
    if (skip > 0)
        --skip;
    else if (state == SETTLING && settling.frame(clock_ms()))
        run();
    else if (state == CHECKING)
        check(brightness);
}

void Camera::start(const camera_order_t &order)
{
    const esp_err_t error = camera_power_up();
    sensor = error == ESP_OK ? esp_camera_sensor_get() : nullptr;
    if (sensor == nullptr) {
        fail();
        return;
    }
    if (proof == LOCK_REFUTED)
        proof = LOCK_UNPROVEN;
    if (order.serial != serial)
        adopt(order);
    /* A sensor that starts is automatic: with the values known, and a white
     * balance that can be set, its frames need not be waited for. */
    settle(settings.lock == 0 || sensor_values_are_given(settings) ||
           (lock_at_known && sensor_white_balance_is_given(settings)));
}

void Camera::adopt(const camera_order_t &order)
{
    settings = order.settings;
    serial = order.serial;
    lock_at_known = false;
    proof = LOCK_UNPROVEN;
}

void Camera::apply(const camera_order_t &order)
{
    adopt(order);
    if (state == RUNNING && settings.lock != 0 &&
        sensor_values_are_given(settings)) {
        run();
        return;
    }
    locked = false;
    if (sensor_release(sensor) == SENSOR_FAILED)
        fail();
    else if (state == RUNNING && settings.lock == 0)
        run();
    else
        settle(settings.lock == 0);
}

void Camera::settle(bool only_first_frames)
{
    state = SETTLING;
    settling.begin(clock_ms(), only_first_frames);
    fresh_us = clock_us();
    skip = 0;
}

/* Locks where that is wanted, and checks a lock that was not proven yet by its
 * picture, before frames go to the dock. */
void Camera::run()
{
    if (settings.lock != 0) {
        lock();
        if (locked && proof != LOCK_PROVEN &&
            values.exposure >= LOCK_CHECK_SHORTEST) {
            state = CHECKING;
            lock_check.begin(clock_ms());
        }
        return;
    }
    state = RUNNING;
    values = sensor_read(sensor);
    read_ms = clock_ms();
    fresh_us = clock_us();
    skip = CAMERA_FRAMES_AFTER_A_CHANGE;
}

void Camera::lock()
{
    const sensor_result_t result = sensor_lock(
        sensor, settings, lock_at_known ? &lock_at : nullptr, &values);
    if (result == SENSOR_FAILED) {
        fail();
        return;
    }
    /* One that reads back something else delivers frames all the same; the
     * dock reports that they are of an unlocked camera. */
    locked = result == SENSOR_OK && proof != LOCK_REFUTED;
    if (locked) {
        lock_at = values;
        lock_at_known = true;
    }
    state = RUNNING;
    read_ms = clock_ms();
    fresh_us = clock_us();
    skip = CAMERA_FRAMES_AFTER_A_CHANGE;
}

/* Shortens the exposure and brings it back, and sees whether the picture
 * follows. */
void Camera::check(uint32_t brightness)
{
    const bool was_half = lock_check.half();
    lock_check.frame(clock_ms(), brightness);
    if (lock_check.half() != was_half) {
        const int exposure = was_half ? lock_at.exposure : lock_at.exposure / 2;
        if (sensor->set_aec_value(sensor, exposure) != 0) {
            fail();
            return;
        }
    }
    if (!lock_check.over())
        return;
    proof = lock_check.proof();
    locked = proof != LOCK_REFUTED;
    state = RUNNING;
    skip = was_half ? CAMERA_FRAMES_AFTER_A_CHANGE : 0;
}

/* Once a second: what does it use now, and has it lost its lock? */
void Camera::look_after_sensor()
{
    if (clock_ms() - read_ms < CAMERA_READ_MS)
        return;
    read_ms = clock_ms();
    values = sensor_read(sensor);
    if (settings.lock == 0 || !sensor_takes_commands(sensor))
        return;
    if ((!locked && proof != LOCK_REFUTED) ||
        values.exposure != lock_at.exposure || values.gain != lock_at.gain ||
        sensor->status.aec != 0 || sensor->status.agc != 0)
        run();
}

/* With every buffer in hand the driver has nothing to fill: it stops after the
 * frame that it is at, and the last one comes only then. */
void Camera::pause()
{
    while (state != WITHOUT && held_count < CAMERA_BUFFERS) {
        camera_fb_t *frame = esp_camera_fb_get();
        if (frame == nullptr)
            fail();
        else
            held[held_count++] = frame;
    }
}

void Camera::resume()
{
    if (held_count == 0)
        return;
    give_back();
    fresh_us = clock_us();
}

void Camera::give_back()
{
    while (held_count > 0)
        esp_camera_fb_return(held[--held_count]);
}

/* Only from one frame of a locked sensor to the next: automatic loops need
 * frames, and so does everything before the lock. */
bool Camera::may_rest(const camera_order_t &order) const
{
    return state == RUNNING && locked && order.serial == serial &&
           order.rest_ms > 0 && skip == 0 && sensor_takes_commands(sensor) &&
           clock_ms() - delivered_ms < order.rest_ms;
}

void Camera::rest()
{
    if (resting)
        return;
    pause();
    if (state == WITHOUT)
        return;
    if (!sensor_rest(sensor, true)) {
        fail();
        return;
    }
    processor_rest(true);
    resting = true;
}

void Camera::wake()
{
    if (!resting)
        return;
    resting = false;
    processor_rest(false);
    if (!sensor_rest(sensor, false)) {
        fail();
        return;
    }
    skip = CAMERA_FRAMES_AFTER_A_CHANGE;
    read_ms = clock_ms() - CAMERA_READ_MS; /* is it still locked? */
}

void Camera::fail()
{
    give_back();
    if (resting)
        processor_rest(false);
    resting = false;
    camera_power_down();
    sensor = nullptr;
    locked = false;
    state = WITHOUT;
    fault_due = true;
    backoff.fail(clock_ms());
}
