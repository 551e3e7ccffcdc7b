/* One turn of the colour task: bytes in, camera reports, requests, LEDs, bytes
 * out.  It alone touches the dock, the LEDs, the port and the flash. */
#ifndef LOOP_H
#define LOOP_H

#include "camera.h"
#include "core.h"
#include "exposure.h"

enum {
    LOOP_WAIT_MS = 2, /* for the camera: what a byte waits at most */
    /* A host that keeps asking shall not put off a restart for ever. */
    LOOP_LAST_WORDS_MS = 500,
    /* Longer than a driver waits for a frame and starts anew.  One that does
     * not return after all is left to the chip's own watchdog. */
    LOOP_PAUSE_MS = 10000,
    LOOP_OUT = 512, /* bytes, whole messages: the longest has 280 */
};

class Loop
{
  public:
    explicit Loop(dock_t *dock);

    /* The dock is set up, the mailbox started with this order. */
    void begin(const camera_order_t &order);

    void turn();

  private:
    void receive();
    void camera();
    void paused();
    void save();
    void rest();
    void requests();
    void leds();
    void transmit();
    void restart_when_silent();

    dock_t *dock;
    camera_order_t order = {};
    Exposure exposure;
    uint8_t out[LOOP_OUT] = {};
    size_t out_length = 0;
    size_t out_sent = 0;
    bool saving = false;        /* once the camera is paused */
    bool restarting = false;    /* once it is, and all bytes are out */
    bool silent = false;        /* nothing more from the dock */
    bool camera_stands = false; /* paused for the restart */
    uint32_t restart_ms = 0;
};

#endif
