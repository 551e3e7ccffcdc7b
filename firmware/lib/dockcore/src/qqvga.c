#include "qqvga.h"

#define WIDTH (2 * METHOD_WORKING_WIDTH)
#define HEIGHT (2 * METHOD_WORKING_HEIGHT)

/* A word is two pixels of swapped bytes, each of them, from the lowest bit,
 * GGG rrrrr bbbbb ggg  with GGG green's high bits. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "little-endian only");

/* Every second field of both pixels: each has room for the sum of four. */
#define BLUE_AND_HIGH_GREEN UINT32_C(0x1F071F07)
#define LOW_GREEN_AND_RED UINT32_C(0x1C1F1C1F) /* after a shift by 3 */

/* working_image.c's mean of four pixels in 32 bits: (4 * full)^2 < 2^23. */
#define FRACTION_BITS 24
#define SCALE(full) (((UINT32_C(255) << FRACTION_BITS) - 1) / (4 * (full)) + 1)
#define HALF (UINT32_C(1) << (FRACTION_BITS - 1))

/* The camera's words, whatever type the bytes were written as. */
typedef uint32_t __attribute__((may_alias)) word_t;

bool qqvga_is_rgb565(const frame_t *frame)
{
    return frame->format == FRAME_RGB565 && frame->width == WIDTH &&
           frame->height == HEIGHT && ((uintptr_t)frame->bytes & 3) == 0;
}

/* The mean of the pixels of two words, one above the other. */
static inline uint32_t mean_pixel(uint32_t upper, uint32_t lower)
{
    uint32_t even =
        (upper & BLUE_AND_HIGH_GREEN) + (lower & BLUE_AND_HIGH_GREEN);
    uint32_t odd =
        (upper >> 3 & LOW_GREEN_AND_RED) + (lower >> 3 & LOW_GREEN_AND_RED);
    even += even >> 16;
    odd += odd >> 16;
    const uint32_t red = odd & 0x7F;
    const uint32_t green = (even & 0x1F) * 8 + (odd >> 10 & 0x1F);
    const uint32_t blue = even >> 8 & 0x7F;
    return pixel_pack((red * SCALE(31) + HALF) >> FRACTION_BITS,
                      (green * SCALE(63) + HALF) >> FRACTION_BITS,
                      (blue * SCALE(31) + HALF) >> FRACTION_BITS);
}

void qqvga_average(working_image_t *image, const frame_t *frame)
{
    const word_t *upper =
        (const word_t *)__builtin_assume_aligned(frame->bytes, 4);
    uint32_t *out = image->pixel;
    for (uint32_t y = 0; y < METHOD_WORKING_HEIGHT; y++) {
        const word_t *lower = upper + WIDTH / 2;
#pragma GCC unroll 2
        for (uint32_t x = 0; x < METHOD_WORKING_WIDTH; x++)
            *out++ = mean_pixel(*upper++, *lower++);
        upper = lower;
    }
}
