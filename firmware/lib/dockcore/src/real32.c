#include "real32.h"

#define FRACTION 23
#define BIAS 127

uint32_t real32_from_fixed(int64_t n, uint8_t shift)
{
    if (n == 0)
        return 0;
    const uint32_t sign = n < 0 ? UINT32_C(1) << 31 : 0;
    uint64_t m = n < 0 ? 0 - (uint64_t)n : (uint64_t)n;
    int exponent = BIAS + FRACTION - shift;
    while (m < UINT64_C(1) << FRACTION) {
        m <<= 1;
        exponent--;
    }
    int drop = 0;
    while (m >> drop >= UINT64_C(2) << FRACTION)
        drop++;
    if (drop > 0) {
        const uint64_t half = UINT64_C(1) << (drop - 1);
        const uint64_t odd = m >> drop & 1;
        m = (m + half - 1 + odd) >> drop;
        exponent += drop;
        if (m >> (FRACTION + 1) != 0) { /* rounded up to the next power */
            m >>= 1;
            exponent++;
        }
    }
    const uint32_t fraction = (uint32_t)m & ((UINT32_C(1) << FRACTION) - 1);
    return sign | (uint32_t)exponent << FRACTION | fraction;
}

bool real32_to_fixed(uint32_t bits, uint8_t shift, int64_t *n)
{
    const int exponent = (int)(bits >> FRACTION & 0xFF);
    if (exponent == 0) { /* zero, or nearer to it than anything we count */
        *n = 0;
        return true;
    }
    const uint64_t m =
        (bits & ((UINT32_C(1) << FRACTION) - 1)) | UINT32_C(1) << FRACTION;
    const int up = exponent - BIAS - FRACTION + shift;
    if (up > 52 - FRACTION) /* NaN and infinity too */
        return false;
    uint64_t magnitude;
    if (up >= 0)
        magnitude = m << up;
    else if (up < -FRACTION - 1)
        magnitude = 0;
    else
        magnitude = (m + (UINT64_C(1) << (-up - 1))) >> -up;
    *n = bits >> 31 != 0 ? -(int64_t)magnitude : (int64_t)magnitude;
    return true;
}
