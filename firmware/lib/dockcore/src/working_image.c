#include "working_image.h"

#include "pixel.h"
#include "qqvga.h"

/* First source pixel of cell i of `cells` along an axis. */
static uint32_t edge(uint32_t i, uint32_t pixels, uint32_t cells)
{
    return i * pixels / cells;
}

/* Source pixels from one edge to the next: at least one. */
static uint32_t span(uint32_t from, uint32_t to)
{
    return to > from ? to - from : 1;
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

void working_image_open(working_image_t *image, const frame_t *frame)
{
    image->frame = frame;
    image->is_qqvga = qqvga_is_rgb565(frame);
    if (image->is_qqvga)
        return;
    for (uint32_t i = 0; i <= WORKING_WIDTH; i++)
        image->column[i] = (uint16_t)edge(i, frame->width, WORKING_WIDTH);

    /* The first cell is the smallest; others are as large or one pixel larger
     * either way. */
    const uint32_t narrow = span(0, image->column[1]);
    const uint32_t low = span(0, edge(1, frame->height, WORKING_HEIGHT));
    const bool rgb565 = frame->format == FRAME_RGB565;
    image->narrow = (uint16_t)narrow;
    image->low = (uint16_t)low;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t count = (low + i / 2) * (narrow + i % 2);
        image->green_scale[i / 2][i % 2] = mean_scale(rgb565 ? 63 : 255, count);
        image->other_scale[i / 2][i % 2] = mean_scale(rgb565 ? 31 : 255, count);
    }
}

/* A row of a frame of any size. */
static void average_row(const working_image_t *image, uint32_t y,
                        uint32_t row[WORKING_WIDTH])
{
    const frame_t *frame = image->frame;
    const bool rgb565 = frame->format == FRAME_RGB565;
    const size_t step = rgb565 ? 2 : 3;
    const size_t stride = step * frame->width;
    const uint32_t top = edge(y, frame->height, WORKING_HEIGHT);
    const uint32_t height =
        span(top, edge(y + 1, frame->height, WORKING_HEIGHT));
    const uint64_t *green_scale = image->green_scale[height - image->low];
    const uint64_t *other_scale = image->other_scale[height - image->low];
    for (uint32_t x = 0; x < WORKING_WIDTH; x++) {
        const uint32_t left = image->column[x];
        const uint32_t width = span(left, image->column[x + 1]);
        const uint8_t *box = frame->bytes + top * stride + left * step;
        const sums_t sums = rgb565 ? sum_rgb565(box, stride, width, height)
                                   : sum_rgb888(box, stride, width, height);
        const uint32_t wider = width - image->narrow;
        row[x] = pixel_pack(mean_of(sums.red, other_scale[wider]),
                            mean_of(sums.green, green_scale[wider]),
                            mean_of(sums.blue, other_scale[wider]));
    }
}

void working_image_row(const working_image_t *image, uint32_t y,
                       uint32_t row[WORKING_WIDTH])
{
    if (image->is_qqvga)
        qqvga_row(image->frame, y, row);
    else
        average_row(image, y, row);
}
