/* What the compiler calls and nobody provides: some functions of the C
 * library, and the divisions and products that libgcc for lx106 lacks.
 * Compiled so that no loop in here turns into a call of itself. */
#include <stdint.h>
#include <string.h>

#define WORD_MASK (sizeof(uint32_t) - 1)

/* A word that may alias anything, as the bytes that it stands for do. */
typedef uint32_t __attribute__((may_alias)) word_t;

void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    uint8_t *out = to;
    const uint8_t *in = from;
    if ((((uintptr_t)out | (uintptr_t)in) & WORD_MASK) == 0)
        for (; n >= sizeof(word_t); n -= sizeof(word_t)) {
            *(word_t *)(void *)out = *(const word_t *)(const void *)in;
            out += sizeof(word_t);
            in += sizeof(word_t);
        }
    for (; n > 0; n--)
        *out++ = *in++;
    return to;
}

void *memset(void *to, int byte, size_t n)
{
    const uint32_t word = (uint8_t)byte * UINT32_C(0x01010101);
    uint8_t *out = to;
    if (((uintptr_t)out & WORD_MASK) == 0)
        for (; n >= sizeof(word_t); n -= sizeof(word_t)) {
            *(word_t *)(void *)out = word;
            out += sizeof(word_t);
        }
    for (; n > 0; n--)
        *out++ = (uint8_t)byte;
    return to;
}

int memcmp(const void *a, const void *b, size_t n)
{
    const uint8_t *left = a, *right = b;
    for (; n > 0; n--, left++, right++)
        if (*left != *right)
            return *left - *right;
    return 0;
}

void *memmove(void *to, const void *from, size_t n)
{
    uint8_t *out = to;
    const uint8_t *in = from;
    if (out <= in)
        return memcpy(to, from, n); /* goes upwards */
    while (n-- > 0)
        out[n] = in[n];
    return to;
}

void *memchr(const void *bytes, int byte, size_t n)
{
    for (const uint8_t *in = bytes; n > 0; n--, in++)
        if (*in == (uint8_t)byte)
            return (void *)(uintptr_t)in;
    return NULL;
}

size_t strlen(const char *text)
{
    size_t n = 0;
    while (text[n] != '\0')
        n++;
    return n;
}

int strncmp(const char *a, const char *b, size_t n)
{
    for (; n > 0; n--, a++, b++)
        if (*a != *b || *a == '\0')
            return (unsigned char)*a - (unsigned char)*b;
    return 0;
}

typedef struct {
    uint32_t quotient, remainder;
} division_t;

/* Digit by digit; a zero divisor gives a full quotient, as on most machines. */
static inline division_t divide(uint32_t dividend, uint32_t divisor)
{
    division_t result = {0, dividend};
    if (divisor == 0)
        result.quotient = UINT32_MAX;
    else if (dividend >= divisor)
        for (int shift = __builtin_clz(divisor) - __builtin_clz(dividend);
             shift >= 0; shift--) {
            const uint32_t part = divisor << shift;
            result.quotient <<= 1;
            if (result.remainder >= part) {
                result.remainder -= part;
                result.quotient |= 1;
            }
        }
    return result;
}

static uint32_t magnitude(int32_t value)
{
    return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

uint32_t __udivsi3(uint32_t dividend, uint32_t divisor)
{
    return divide(dividend, divisor).quotient;
}

uint32_t __umodsi3(uint32_t dividend, uint32_t divisor)
{
    return divide(dividend, divisor).remainder;
}

int32_t __divsi3(int32_t dividend, int32_t divisor)
{
    const uint32_t quotient =
        divide(magnitude(dividend), magnitude(divisor)).quotient;
    return (int32_t)((dividend ^ divisor) < 0 ? 0u - quotient : quotient);
}

/* 32 x 32 to 64 bits from four 16 x 16 products. */
static uint64_t multiply(uint32_t a, uint32_t b)
{
    const uint32_t a_low = a & 0xFFFF, a_high = a >> 16;
    const uint32_t b_low = b & 0xFFFF, b_high = b >> 16;
    const uint32_t low = a_low * b_low;
    const uint32_t middle = a_high * b_low + (low >> 16);
    const uint32_t other = a_low * b_high + (middle & 0xFFFF);
    const uint32_t high = a_high * b_high + (middle >> 16) + (other >> 16);
    return (uint64_t)high << 32 | (other << 16 | (low & 0xFFFF));
}

uint64_t __muldi3(uint64_t a, uint64_t b)
{
    const uint32_t a_high = (uint32_t)(a >> 32), b_high = (uint32_t)(b >> 32);
    const uint32_t crossed = a_high * (uint32_t)b + (uint32_t)a * b_high;
    return multiply((uint32_t)a, (uint32_t)b) + ((uint64_t)crossed << 32);
}

typedef struct {
    uint64_t quotient, remainder;
} wide_division_t;

static wide_division_t divide_wide(uint64_t dividend, uint64_t divisor)
{
    wide_division_t result = {0, 0};
    for (int bit = 63; bit >= 0; bit--) {
        const uint32_t carry = (uint32_t)(result.remainder >> 63);
        result.remainder = result.remainder << 1 | dividend >> 63;
        dividend <<= 1;
        result.quotient <<= 1;
        if (carry != 0 || result.remainder >= divisor) {
            result.remainder -= divisor;
            result.quotient |= 1;
        }
    }
    return result;
}

uint64_t __udivdi3(uint64_t dividend, uint64_t divisor)
{
    return divide_wide(dividend, divisor).quotient;
}

uint64_t __umoddi3(uint64_t dividend, uint64_t divisor)
{
    return divide_wide(dividend, divisor).remainder;
}

int64_t __divdi3(int64_t dividend, int64_t divisor)
{
    const uint64_t a =
        dividend < 0 ? 0 - (uint64_t)dividend : (uint64_t)dividend;
    const uint64_t b = divisor < 0 ? 0 - (uint64_t)divisor : (uint64_t)divisor;
    const uint64_t quotient = divide_wide(a, b).quotient;
    return (int64_t)((dividend ^ divisor) < 0 ? 0 - quotient : quotient);
}
