#include "settling.h"

void Settling::begin(uint32_t now_ms, bool values_known)
{
    began_ms = now_ms;
    frames = 0;
    known = values_known;
}

bool Settling::frame(uint32_t now_ms)
{
    ++frames;
    const uint32_t passed = now_ms - began_ms;
    if (passed >= SETTLING_LONGEST_MS)
        return true;
    if (known)
        return frames >= SETTLING_KNOWN_FRAMES;
    return frames >= SETTLING_FRAMES && passed >= SETTLING_MS;
}
