/* When the first light of a frame was gathered.
 *
 * The driver stamps a frame when the sensor begins to send it.  Its first row
 * was exposed before that, for a frame's period at most: longer than all its
 * rows a sensor does not expose.  Frames that come late or not at all only make
 * the time between two of them longer, so the shortest of the last ones is the
 * period. */
#ifndef EXPOSURE_H
#define EXPOSURE_H

#include <stddef.h>
#include <stdint.h>

class Exposure
{
  public:
    /* How long ago it was, of a frame that began at began_us; more than a
     * minute where the period is not known yet. */
    uint32_t age_ms(int64_t began_us, int64_t now_us);

  private:
    enum { KEPT = 8 };
    static const int64_t UNKNOWN_US = 60000000;

    int64_t last_us = -UNKNOWN_US;
    int64_t apart_us[KEPT] = {UNKNOWN_US, UNKNOWN_US, UNKNOWN_US, UNKNOWN_US,
                              UNKNOWN_US, UNKNOWN_US, UNKNOWN_US, UNKNOWN_US};
    size_t next = 0;
};

#endif
