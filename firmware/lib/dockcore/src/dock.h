/* The dock: camera frames, bytes and time go in; LED duties, bytes and requests
 * to the board come out.
 *
 * It reads no clock, owns no memory beyond dock_t, calls no driver, and does
 * the same on the board, in the tests and inside Python. */
#ifndef DOCK_H
#define DOCK_H

#include "dock_state.h"

/* What a board gives to snapshots and injected frames: one QQVGA RGB565 frame.
 */
#define DOCK_IMAGE_BYTES 38400

/* Starts with dark LEDs.  A setting that is out of its range gives way to its
 * default. */
void dock_init(dock_t *dock, const dock_settings_t *settings);

void dock_set_board(dock_t *dock, const dock_board_t *board);

void dock_set_camera(dock_t *dock, const dock_camera_t *camera);

/* The hue shown before a reset, which a dock without a camera goes back to; to
 * be told before the first frame.  One out of range is none. */
void dock_set_last_hue(dock_t *dock, uint16_t hue);

/* The marker's hue, to be kept over a reset. */
uint16_t dock_hue(const dock_t *dock);

/* A camera frame, or a camera fault: frame NULL or without bytes.  A fault, or
 * a frame that is not valid, is counted and changes no colour.  While a host
 * injects frames the camera's are passed over.
 *
 * A frame that was exposed while the lamps went out or on again tells nothing
 * of their light: its age_ms must be no less than the time since the first of
 * its light was gathered.  For a rolling shutter that runs freely that is at
 * most a frame's period before its first row is read. */
void dock_frame(dock_t *dock, const frame_t *frame, uint32_t now_ms);

/* Bytes from the host, in any pieces, with anything between the messages. */
void dock_receive(dock_t *dock, const uint8_t *bytes, size_t n,
                  uint32_t now_ms);

/* Bytes for the host: as many whole messages as fit into `capacity`.  To be
 * called often, whatever comes in; it also sends what is due by the clock. */
size_t dock_transmit(dock_t *dock, uint8_t *bytes, size_t capacity,
                     uint32_t now_ms);

/* The next thing that the board should do, each told once. */
dock_request_t dock_take_request(dock_t *dock);

/* How long the camera may rest between two frames, milliseconds: decision_ms,
 * but not before the first decision, nor while a host waits for a snapshot or
 * the lamps are out for the next frame.  Changes with a frame, and has to be
 * heeded before the camera goes on. */
uint32_t dock_rest_ms(const dock_t *dock);

/* Whether the board could write the settings that it was asked to. */
void dock_saved(dock_t *dock, bool written);

/* PWM duties R, G, B, 0..LED_FULL, with correction, limit and polarity; to be
 * called often, 10 ms apart at most, and the LEDs driven so at once: now and
 * then they are dark for less than 0.2 s (look.h). */
void dock_led_duties(dock_t *dock, uint16_t duty[3], uint32_t now_ms);

#endif
