#include "qqvga.h"

#include "pixel.h"

#define WIDTH (2 * METHOD_WORKING_WIDTH)
#define HEIGHT (2 * METHOD_WORKING_HEIGHT)

/* A word is two pixels of swapped bytes, each of them, from the lowest bit,
 * GGG rrrrr bbbbb ggg  with GGG green's high bits. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "little-endian only");

/* Every second field of both pixels: each has room for the sum of four. */
#define BLUE_AND_HIGH_GREEN UINT32_C(0x1F071F07)
#define LOW_GREEN_AND_RED UINT32_C(0x1C1F1C1F) /* after a shift by 3 */

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
    return ((uint32_t)METHOD_MEAN_RED_OR_BLUE[red] << PIXEL_RED_SHIFT) +
           METHOD_MEAN_GREEN[green] + METHOD_MEAN_RED_OR_BLUE[blue];
}

void qqvga_row(const frame_t *frame, uint32_t y,
               uint32_t row[METHOD_WORKING_WIDTH])
{
    const word_t *upper =
        (const word_t *)__builtin_assume_aligned(frame->bytes, 4) + y * WIDTH;
    const word_t *lower = upper + WIDTH / 2;
#pragma GCC unroll 2
    for (uint32_t x = 0; x < METHOD_WORKING_WIDTH; x++)
        row[x] = mean_pixel(upper[x], lower[x]);
}
