/* The camera as the dock wants it: frames of a locked sensor, or a fault; and
 * after a fault it tries again for ever.
 *
 *   without --(back-off over)--> settling --(lock)--> checking --> running
 *      ^                            |                    |            |
 *      +---- no frame, no answer ---+--------------------+------------+
 *
 * While it is running and locked it may rest from one frame to the next, the
 * driver between frames and the sensor in standby.
 *
 * Its calls block in the driver, up to 4 s for a frame, so it lives in a task
 * of its own and talks with the colour task in orders and reports. */
#ifndef CAMERA_H
#define CAMERA_H

#include <esp_camera.h>

#include "backoff.h"
#include "camera_power.h"
#include "core.h"
#include "lock_check.h"
#include "sensor_lock.h"
#include "settling.h"

enum {
    /* A change reaches the frames one or two later. */
    CAMERA_FRAMES_AFTER_A_CHANGE = 3,
    /* While there is no camera it says so this often. */
    CAMERA_FAULT_MS = 1000,
    /* An automatic exposure is read, a lock that failed repeated, this often.
     */
    CAMERA_READ_MS = 1000,
};

struct camera_order_t {
    camera_settings_t settings;
    uint32_t serial;  /* another number: apply the settings afresh */
    bool pause;       /* capture nothing */
    uint32_t rest_ms; /* from a frame to the next, at least; 0: all frames */
};

enum camera_event_t {
    CAMERA_NOTHING,
    CAMERA_FRAME,
    CAMERA_FAULT,
    CAMERA_PAUSED, /* the driver is between frames, and stays there */
};

struct camera_report_t {
    camera_event_t event;
    camera_fb_t *frame; /* of CAMERA_FRAME, until camera.release */
    dock_camera_t camera;
};

/* When the sensor began to send it, by clock_us. */
int64_t camera_began_us(const camera_fb_t &frame);

class Camera
{
  public:
    /* One frame, or one wait for it.  With CAMERA_NOTHING the caller may sleep
     * a moment.  A report's frame has to be released before the next step. */
    camera_report_t step(const camera_order_t &order);

    void release(const camera_report_t &report);

    const Backoff &retry() const
    {
        return backoff;
    }

  private:
    enum state_t { WITHOUT, SETTLING, CHECKING, RUNNING };

    void start(const camera_order_t &order);
    void adopt(const camera_order_t &order);
    void apply(const camera_order_t &order);
    void settle(bool only_first_frames);
    void run();
    void lock();
    void check(uint32_t brightness);
    void look_after_sensor();
    void drop(camera_fb_t *frame);
    bool is_stale(const camera_fb_t &frame) const;
    void pause();
    void resume();
    void give_back();
    bool may_rest(const camera_order_t &order) const;
    void rest();
    void wake();
    void fail();
    camera_report_t report(camera_event_t event, camera_fb_t *frame) const;
    camera_report_t report_no_camera();

    state_t state = WITHOUT;
    Backoff backoff;
    Settling settling;
    camera_settings_t settings = {};
    uint32_t serial = 0;
    sensor_t *sensor = nullptr;
    sensor_values_t values = {}; /* as last read */
    bool locked = false;
    LockCheck lock_check;
    lock_proof_t proof = LOCK_UNPROVEN; /* with these settings */
    sensor_values_t lock_at = {};
    bool lock_at_known = false; /* locked once with these settings */
    int64_t fresh_us = 0;       /* frames that began earlier are stale */
    unsigned skip = 0;          /* fresh ones to drop all the same */
    uint32_t read_ms = 0;
    uint32_t fault_ms = 0;
    bool fault_due = false;
    bool resting = false;
    uint32_t delivered_ms = 0;
    camera_fb_t *held[CAMERA_BUFFERS] = {};
    unsigned held_count = 0;
};

#endif
