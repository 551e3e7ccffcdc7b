#include "working_image.h"

#include "qqvga.h"

/* First source pixel of each cell along one axis, and the last cell's end. */
static void set_edges(uint16_t *edge, uint32_t pixels, uint32_t cells)
{
    for (uint32_t i = 0; i <= cells; i++)
        edge[i] = (uint16_t)(i * pixels / cells);
}

/* Source pixels from one edge to the next: at least one. */
static uint32_t span(const uint16_t *edge)
{
    const uint32_t size = (uint32_t)edge[1] - edge[0];
    return size > 0 ? size : 1;
}

/* The mean of `sum` over `count` pixels of full scale `full`, on 0..255, is
 *     floor((510 * sum + full * count) / (2 * full * count)).
 * Multiplying by the reciprocal, rounded up, gives the same as long as
 * (full * count)^2 < 2^(FRACTION_BITS - 1): no sum that is not itself a tie
 * comes nearer to one than the reciprocal's error. */
#define FRACTION_BITS 48

static uint64_t mean_scale(uint32_t full, uint32_t count)
{
    return ((UINT64_C(255) << FRACTION_BITS) - 1) / (full * count) + 1;
}

static uint32_t mean_of(uint32_t sum, uint64_t scale)
{
    const uint64_t half = UINT64_C(1) << (FRACTION_BITS - 1);
    return (uint32_t)((sum * scale + half) >> FRACTION_BITS);
}

typedef struct {
    uint32_t red, green, blue;
} sums_t;

static sums_t sum_rgb565(const uint8_t *row, size_t stride, uint32_t width,
                         uint32_t height)
{
    sums_t sums = {0, 0, 0};
    for (; height > 0; height--, row += stride) {
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t word = (uint32_t)row[2 * x] << 8 | row[2 * x + 1];
            sums.red += word >> 11;
            sums.green += word >> 5 & 63;
            sums.blue += word & 31;
        }
    }
    return sums;
}

static sums_t sum_rgb888(const uint8_t *row, size_t stride, uint32_t width,
                         uint32_t height)
{
    sums_t sums = {0, 0, 0};
    for (; height > 0; height--, row += stride) {
        for (uint32_t x = 0; x < width; x++) {
            sums.red += row[3 * x];
            sums.green += row[3 * x + 1];
            sums.blue += row[3 * x + 2];
        }
    }
    return sums;
}

/* A frame of any size. */
static void average(working_image_t *image, const frame_t *frame)
{
    const bool rgb565 = frame->format == FRAME_RGB565;
    const size_t step = rgb565 ? 2 : 3;
    const size_t stride = step * frame->width;
    uint16_t column[METHOD_WORKING_WIDTH + 1], row[METHOD_WORKING_HEIGHT + 1];
    set_edges(column, frame->width, METHOD_WORKING_WIDTH);
    set_edges(row, frame->height, METHOD_WORKING_HEIGHT);

    /* The first cell is the narrowest; others are as wide or one pixel wider.
     */
    const uint32_t narrow = span(column), low = span(row);
    uint64_t green[2][2], other[2][2]; /* [one row more][one column more] */
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t count = (low + i / 2) * (narrow + i % 2);
        green[i / 2][i % 2] = mean_scale(rgb565 ? 63 : 255, count);
        other[i / 2][i % 2] = mean_scale(rgb565 ? 31 : 255, count);
    }

    uint32_t *out = image->pixel;
    for (uint32_t y = 0; y < METHOD_WORKING_HEIGHT; y++) {
        const uint32_t height = span(row + y);
        for (uint32_t x = 0; x < METHOD_WORKING_WIDTH; x++) {
            const uint32_t width = span(column + x);
            const uint8_t *box =
                frame->bytes + row[y] * stride + column[x] * step;
            const sums_t sums = rgb565 ? sum_rgb565(box, stride, width, height)
                                       : sum_rgb888(box, stride, width, height);
            const uint64_t *green_scale = green[height - low];
            const uint64_t *other_scale = other[height - low];
            *out++ =
                pixel_pack(mean_of(sums.red, other_scale[width - narrow]),
                           mean_of(sums.green, green_scale[width - narrow]),
                           mean_of(sums.blue, other_scale[width - narrow]));
        }
    }
}

void working_image_from_frame(working_image_t *image, const frame_t *frame)
{
    if (qqvga_is_rgb565(frame))
        qqvga_average(image, frame);
    else
        average(image, frame);
}
