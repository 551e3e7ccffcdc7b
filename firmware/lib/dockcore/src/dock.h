/* The dock: camera frames and time go in, LED duties come out.
 *
 * It reads no clock, owns no memory beyond this struct, calls no driver, and
 * does the same on the board, in the tests and inside Python. */
#ifndef DOCK_H
#define DOCK_H

#include "background.h"
#include "frame.h"
#include "led.h"
#include "marker.h"
#include "rolling.h"

typedef struct {
    uint8_t mapping;       /* METHOD_MAPPING_... */
    uint16_t fallback_hue; /* marker where the water's hue means nothing */
    uint16_t window_ms;    /* METHOD_MIN_WINDOW_MS..METHOD_MAX_WINDOW_MS */
    led_settings_t led;
} dock_settings_t;

/* Counted since dock_init; at UINT32_MAX they stay. */
typedef struct {
    uint32_t frames;        /* decided on */
    uint32_t camera_faults; /* the camera gave no frame */
    uint32_t frame_faults;  /* a frame whose length, size or format is wrong */
} dock_counters_t;

typedef struct {
    dock_settings_t settings;
    dock_counters_t counters;
    working_image_t image; /* smoothed, of the last good frame */
    background_t background;
    rolling_t rolling;
    uint16_t decided_hue; /* of the last good frame */
    uint16_t marker_hue;  /* the rolling mean: what the LEDs show */
    bool decided;         /* false until the first good frame: LEDs dark */
} dock_t;

dock_settings_t dock_default_settings(void);

bool dock_settings_are_valid(const dock_settings_t *settings);

/* Starts with dark LEDs.  Settings that are not valid give way to the default
 * ones: a dock with a corrupt flash still lights up. */
void dock_init(dock_t *dock, const dock_settings_t *settings);

/* A camera frame, or a camera fault: frame NULL or without bytes.  A fault, or
 * a frame that is not valid, is counted and changes no colour. */
void dock_frame(dock_t *dock, const frame_t *frame, uint32_t now_ms);

/* PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity. */
void dock_led_duties(const dock_t *dock, uint16_t duty[3]);

#endif
