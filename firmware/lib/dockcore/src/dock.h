/* The dock: camera frames, bytes and time go in; LED duties, bytes and requests
 * to the board come out.
 *
 * It reads no clock, owns no memory beyond this struct, calls no driver, and
 * does the same on the board, in the tests and inside Python. */
#ifndef DOCK_H
#define DOCK_H

#include "background.h"
#include "frame.h"
#include "led.h"
#include "link.h"
#include "marker.h"
#include "rolling.h"
#include "settings.h"

/* Counted since dock_init; at UINT32_MAX they stay. */
typedef struct {
    uint32_t frames;        /* decided on */
    uint32_t camera_faults; /* the camera gave no frame */
    uint32_t frame_faults;  /* a frame whose length, size or format is wrong */
} dock_counters_t;

/* What a board gives to snapshots and injected frames: one QQVGA RGB565 frame.
 */
#define DOCK_IMAGE_BYTES 38400

/* What the board knows of itself, told once after dock_init. */
typedef struct {
    uint8_t reset_reason;  /* as the chip counts */
    bool settings_corrupt; /* what flash held was no valid blob */
    uint8_t git_hash[8];   /* ASCII, first letters of the commit */
    uint8_t *buffer;       /* for a snapshot or an injected frame; NULL: none */
    uint32_t capacity;     /* of it, bytes; even address */
} dock_board_t;

/* What the camera is set to now, read back from the sensor. */
typedef struct {
    uint16_t exposure;
    uint8_t gain;
    bool locked;
} dock_camera_t;

/* What only the board can do.  One at a time, each taken once. */
typedef enum {
    DOCK_REQUEST_NONE,
    DOCK_REQUEST_SAVE,   /* write settings_to_blob to flash, then dock_saved */
    DOCK_REQUEST_CAMERA, /* apply settings.camera */
    DOCK_REQUEST_REBOOT, /* once all bytes of dock_transmit are out */
} dock_request_t;

typedef struct {
    dock_settings_t settings;
    dock_board_t board;
    dock_camera_t camera;
    dock_counters_t counters;
    smoothed_t smoothed; /* only while a frame is decided on */
    background_t background;
    rolling_t rolling;
    uint16_t decided_hue; /* of the last good frame */
    uint16_t marker_hue;  /* the rolling mean: what the LEDs show */
    bool decided;         /* false until the first good frame: LEDs dark */
    uint8_t led_mode;     /* DOCK_LED_AUTO, _HUE, _RAW; until the next start */
    uint16_t led_hue;     /* of DOCK_LED_HUE */
    uint8_t led_raw[3];   /* of DOCK_LED_RAW */
    uint16_t faults;      /* DOCK_FAULT_..., now */
    uint32_t last_frame_ms;   /* of the last frame that the camera delivered */
    uint32_t frame_period_q8; /* mean time between frames, 1/256 ms */
    uint8_t requests;         /* a bit each: 1 << dock_request_t */
    link_t link;
} dock_t;

/* Starts with dark LEDs.  Settings that are not valid give way to the default
 * ones: a dock with a corrupt flash still lights up. */
void dock_init(dock_t *dock, const dock_settings_t *settings);

void dock_set_board(dock_t *dock, const dock_board_t *board);

void dock_set_camera(dock_t *dock, const dock_camera_t *camera);

/* A camera frame, or a camera fault: frame NULL or without bytes.  A fault, or
 * a frame that is not valid, is counted and changes no colour.  While a host
 * injects frames the camera's are passed over. */
void dock_frame(dock_t *dock, const frame_t *frame, uint32_t now_ms);

/* Bytes from the host, in any pieces, with anything between the messages. */
void dock_receive(dock_t *dock, const uint8_t *bytes, size_t n,
                  uint32_t now_ms);

/* Bytes for the host: as many whole messages as fit into `capacity`.  To be
 * called often, whatever comes in; it also sends what is due by the clock. */
size_t dock_transmit(dock_t *dock, uint8_t *bytes, size_t capacity,
                     uint32_t now_ms);

/* The next thing that the board should do. */
dock_request_t dock_take_request(dock_t *dock);

/* Whether the board could write the settings that it was asked to. */
void dock_saved(dock_t *dock, bool written);

/* PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity. */
void dock_led_duties(const dock_t *dock, uint16_t duty[3]);

#endif
