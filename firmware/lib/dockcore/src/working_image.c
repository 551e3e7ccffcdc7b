#include "working_image.h"

#include <string.h>

/* RGB565 is read as little-endian half words of swapped bytes. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "little-endian only");

typedef struct {
    uint32_t red, green, blue;
} sums_t;

/* Walks the cells of one axis: the source share of each. */
typedef struct {
    uint32_t first, size;                /* the current cell's pixels */
    uint32_t cells, whole, rest, error; /* whole and rest of pixels per cell */
} share_t;

static share_t share_begin(uint32_t pixels, uint32_t cells)
{
    share_t share = {0, 0, cells, pixels / cells, pixels % cells, 0};
    return share;
}

/* Moves to the next cell; the first call to the first.  Returns its start. */
static inline uint32_t share_next(share_t *share)
{
    const uint32_t first = share->first;
    uint32_t size = share->whole;
    share->error += share->rest;
    if (share->error >= share->cells) {
        share->error -= share->cells;
        size++;
    }
    share->first += size;
    share->size = size > 0 ? size : 1;
    return first;
}

/* Shares are of two sizes: the whole part (at least 1) and one more. */
static inline uint32_t share_smaller(const share_t *share)
{
    return share->whole > 0 ? share->whole : 1;
}

/* Mean of `sum` over `count` pixels of full scale `full`, on the scale 0..255:
 * floor((510 * sum + full * count) / (2 * full * count)), without a division a
 * pixel.  With the reciprocal rounded up the fixed-point form is exact as long
 * as (full * count)^2 < 2^(fraction bits - 1): no sum that is not itself a tie
 * comes nearer to one than the reciprocal's error. */
typedef struct {
    uint32_t narrow; /* 24 fraction bits; 0 where that is not exact */
    uint64_t wide;   /* 48 fraction bits, exact for every allowed frame */
} mean_scale_t;

#define NARROW_LIMIT 2896u /* 2896^2 < 2^23 */

static mean_scale_t mean_scale(uint32_t full, uint32_t count)
{
    const uint32_t divisor = full * count;
    mean_scale_t scale = {0, 0};
    if (divisor <= NARROW_LIMIT)
        scale.narrow = ((UINT32_C(255) << 24) - 1) / divisor + 1;
    else
        scale.wide = ((UINT64_C(255) << 48) - 1) / divisor + 1;
    return scale;
}

static inline uint32_t mean_of(uint32_t sum, const mean_scale_t *scale)
{
    if (scale->narrow != 0)
        return (sum * scale->narrow + (UINT32_C(1) << 23)) >> 24;
    return (uint32_t)((sum * scale->wide + (UINT64_C(1) << 47)) >> 48);
}

/* Read low byte first, an RGB565 pixel is  ggg bbbbb rrrrr GGG,  G being
 * green's high bits.  The sum of whole words less those of red and blue leaves
 * green's two parts 13 bits apart: room for PACKED_ROWS rows of a box. */
#define PACKED_RED UINT32_C(0x00F8)
#define PACKED_BLUE UINT32_C(0x1F00)
#define PACKED_ROWS 18u /* 18 * 64 pixels * 7 < 2^13 */

static inline sums_t sum_rgb565(const uint8_t *row, size_t stride,
                                uint32_t width, uint32_t height)
{
    sums_t sums = {0, 0, 0};
    while (height > 0) {
        uint32_t rows = height < PACKED_ROWS ? height : PACKED_ROWS;
        uint32_t all = 0, red = 0, blue = 0;
        height -= rows;
        for (; rows > 0; rows--, row += stride) {
            for (uint32_t x = 0; x < width; x++) {
                uint16_t word;
                memcpy(&word, __builtin_assume_aligned(row + 2 * x, 2),
                       sizeof word);
                all += word;
                red += word & PACKED_RED;
                blue += word & PACKED_BLUE;
            }
        }
        const uint32_t green = all - red - blue;
        sums.red += red >> 3;
        sums.green += (green & 0x1FFF) * 8 + (green >> 13);
        sums.blue += blue >> 8;
    }
    return sums;
}

static inline sums_t sum_rgb888(const uint8_t *row, size_t stride,
                                uint32_t width, uint32_t height)
{
    sums_t sums = {0, 0, 0};
    for (; height > 0; height--, row += stride) {
        const uint8_t *pixel = row;
        for (uint32_t x = 0; x < width; x++, pixel += 3) {
            sums.red += pixel[0];
            sums.green += pixel[1];
            sums.blue += pixel[2];
        }
    }
    return sums;
}

static inline sums_t sum_box(frame_format_t format, const uint8_t *first,
                             size_t stride, uint32_t width, uint32_t height)
{
    if (format == FRAME_RGB888)
        return sum_rgb888(first, stride, width, height);
    if (width == 2 && height == 2) /* the dock's QQVGA: loops unrolled */
        return sum_rgb565(first, stride, 2, 2);
    return sum_rgb565(first, stride, width, height);
}

void working_image_from_frame(working_image_t *image, const frame_t *frame)
{
    const bool rgb565 = frame->format == FRAME_RGB565;
    const size_t step = rgb565 ? 2 : 3;
    const size_t stride = step * frame->width;
    uint32_t *out = image->pixel;
    share_t down = share_begin(frame->height, METHOD_WORKING_HEIGHT);
    share_t across = share_begin(frame->width, METHOD_WORKING_WIDTH);
    const uint32_t width = share_smaller(&across);
    const uint32_t height = share_smaller(&down);
    mean_scale_t green[2][2], other[2][2]; /* [one row more][one column more] */
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t count = (height + i / 2) * (width + i % 2);
        green[i / 2][i % 2] = mean_scale(rgb565 ? 63 : 255, count);
        other[i / 2][i % 2] = mean_scale(rgb565 ? 31 : 255, count);
    }

    for (uint32_t y = 0; y < METHOD_WORKING_HEIGHT; y++) {
        const uint8_t *row = frame->bytes + share_next(&down) * stride;
        const uint32_t tall = down.size - height;
        across = share_begin(frame->width, METHOD_WORKING_WIDTH);
        for (uint32_t x = 0; x < METHOD_WORKING_WIDTH; x++) {
            const uint8_t *first = row + share_next(&across) * step;
            const uint32_t broad = across.size - width;
            const sums_t sums = sum_box(frame->format, first, stride,
                                        across.size, down.size);
            *out++ = pixel_pack(mean_of(sums.red, &other[tall][broad]),
                                mean_of(sums.green, &green[tall][broad]),
                                mean_of(sums.blue, &other[tall][broad]));
        }
    }
}
