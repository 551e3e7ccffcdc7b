/* How long the sensor is left alone after it started: its first frames are dark
 * or green, and its automatic exposure, gain and white balance need frames to
 * find their values. */
#ifndef SETTLING_H
#define SETTLING_H

#include <stdint.h>

enum {
    SETTLING_FRAMES = 20,
    SETTLING_MS = 3000,
    /* Frames that come slowly shall not keep the LEDs dark for ever. */
    SETTLING_LONGEST_MS = 10000,
    /* Enough where the values to lock are known. */
    SETTLING_KNOWN_FRAMES = 10,
};

class Settling
{
  public:
    /* values_known: only the sensor's first frames are to pass. */
    void begin(uint32_t now_ms, bool values_known);

    /* One more frame; true where it was the last one needed. */
    bool frame(uint32_t now_ms);

  private:
    uint32_t began_ms = 0;
    uint32_t frames = 0;
    bool known = false;
};

#endif
