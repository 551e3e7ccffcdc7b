#include "lock_check.h"

enum {
    /* Of the mean of green: below it noise decides, above it white. */
    DARKEST = 4 * 64,
    BRIGHTEST = 58 * 64,
};

void LockCheck::begin(uint32_t now_ms)
{
    phase = FULL;
    result = LOCK_UNPROVEN;
    began_ms = now_ms;
    frames = 0;
}

void LockCheck::frame(uint32_t now_ms, uint32_t brightness)
{
    if (now_ms - began_ms >= LOCK_CHECK_LONGEST_MS) {
        phase = OVER;
        return;
    }
    ++frames;
    if (goes_on())
        return;
    frames = 0;
    switch (phase) {
    case FULL:
        full = brightness;
        phase = HALF;
        break;
    case HALF:
        half_as_long = brightness;
        phase = FULL_AGAIN;
        break;
    case FULL_AGAIN:
        result = judge(brightness);
        phase = OVER;
        break;
    case OVER:
        break;
    }
}

/* Whether this phase wants more frames. */
bool LockCheck::goes_on() const
{
    return (phase == HALF && frames < LOCK_CHECK_HALF_FRAMES) ||
           (phase == FULL_AGAIN && frames < LOCK_CHECK_FULL_FRAMES);
}

lock_proof_t LockCheck::judge(uint32_t again) const
{
    if (full < DARKEST || full > BRIGHTEST)
        return LOCK_UNPROVEN;
    const uint32_t moved = again > full ? again - full : full - again;
    if (moved > full / 16)
        return LOCK_UNPROVEN;
    /* Half the light is at least an eighth less after any gamma that a sensor
     * has: 2.2 leaves 0.73 of it. */
    return half_as_long <= full - full / 8 ? LOCK_PROVEN : LOCK_REFUTED;
}

uint32_t frame_brightness(const camera_fb_t &frame)
{
    uint32_t sum = 0;
    for (size_t i = 0; i + 1 < frame.len; i += 2)
        sum += (frame.buf[i] & 7u) << 3 | frame.buf[i + 1] >> 5;
    return frame.len < 2 ? 0
                         : static_cast<uint32_t>(64ull * sum / (frame.len / 2));
}
