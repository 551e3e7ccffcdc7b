/* Whether a locked sensor is locked, by its picture and not by what it reads
 * back: at half the exposure a still scene must be darker, and at the full one
 * again as it was.  A loop that is still at work would make up for it, and a
 * register without effect would change nothing. */
#ifndef LOCK_CHECK_H
#define LOCK_CHECK_H

#include <esp_camera.h>
#include <stdint.h>

enum {
    /* Frames that a loop gets to make up for a shorter exposure; and what the
     * full one takes to be seen again. */
    LOCK_CHECK_HALF_FRAMES = 6,
    LOCK_CHECK_FULL_FRAMES = 4,
    /* Frames that come slowly shall not keep the LEDs dark for ever. */
    LOCK_CHECK_LONGEST_MS = 4000,
    /* Half of less can be no whole number of lines that means something. */
    LOCK_CHECK_SHORTEST = 4,
};

enum lock_proof_t {
    LOCK_UNPROVEN, /* too dark, burnt out, not still, frames too slow */
    LOCK_PROVEN,
    LOCK_REFUTED, /* the picture does not follow the exposure */
};

class LockCheck
{
  public:
    /* The sensor is locked at the full exposure. */
    void begin(uint32_t now_ms);

    /* One more frame, of this brightness. */
    void frame(uint32_t now_ms, uint32_t brightness);

    /* Whether the next frame has to be of half the exposure. */
    bool half() const
    {
        return phase == HALF;
    }

    bool over() const
    {
        return phase == OVER;
    }

    /* Of a check that is over. */
    lock_proof_t proof() const
    {
        return result;
    }

  private:
    enum phase_t { FULL, HALF, FULL_AGAIN, OVER };

    bool goes_on() const;
    lock_proof_t judge(uint32_t again) const;

    phase_t phase = OVER;
    lock_proof_t result = LOCK_UNPROVEN;
    uint32_t began_ms = 0;
    uint32_t frames = 0; /* of this phase */
    uint32_t full = 0;   /* brightness, as is half_as_long */
    uint32_t half_as_long = 0;
};

/* Mean of the green of an RGB565 frame, 0 to 63 * 64. */
uint32_t frame_brightness(const camera_fb_t &frame);

#endif
