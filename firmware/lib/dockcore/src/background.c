#include "background.h"

#include <string.h>

#include "hsv.h"
#include "pixel.h"

_Static_assert(METHOD_GREY_RED + METHOD_GREY_GREEN + METHOD_GREY_BLUE ==
                   1 << METHOD_GREY_SHIFT,
               "white is more or less than 255");

/* What OpenCV's COLOR_RGB2GRAY shifts right by METHOD_GREY_SHIFT, less a half.
 * The three weights add up to 1, so that two products are enough. */
static inline uint32_t weighted(uint32_t red, uint32_t green, uint32_t blue)
{
    return (blue << METHOD_GREY_SHIFT) + METHOD_GREY_RED * (red - blue) +
           METHOD_GREY_GREEN * (green - blue);
}

#define GREY_HALF (UINT32_C(1) << (METHOD_GREY_SHIFT - 1))

static inline uint32_t bin_of(uint32_t weighted)
{
    return ((weighted + GREY_HALF) >> METHOD_GREY_SHIFT) * METHOD_GREY_BINS >>
           8;
}

/* The least grey of a bin: five equal intervals. */
static uint32_t first_grey(uint32_t bin)
{
    return (256 * bin + METHOD_GREY_BINS - 1) / METHOD_GREY_BINS;
}

/* Summed up over the pixels of one bin. */
typedef struct {
    hue_vector_t hue;
    uint32_t chroma, saturation, value;
} moments_t;

typedef struct {
    uint8_t bin;
    uint32_t from, span; /* of `weighted` in that bin */
    moments_t moments;   /* of its pixels */
    uint32_t count[METHOD_GREY_BINS];
} sums_t;

/* Twice in a row's loop, or the loop itself took a tenth of the time; and
 * always inline, or the moments were stored after each pixel. */
static inline __attribute__((always_inline)) void
add_pixel(moments_t *moments, sums_t *sums, uint32_t pixel)
{
    const uint32_t red = pixel_red(pixel), green = pixel_green(pixel),
                   blue = pixel_blue(pixel);
    const uint32_t grey = weighted(red, green, blue);
    if (grey - sums->from >= sums->span) {
        sums->count[bin_of(grey)]++;
        return;
    }
    const hsv_t hsv = hsv_from_rgb(red, green, blue);
    const int32_t chroma = (int32_t)hsv.chroma;
    const int16_t *sine = METHOD_SINE + hsv.hue;
    moments->hue.x += chroma * sine[METHOD_HUE_RANGE / 4];
    moments->hue.y += chroma * sine[0];
    moments->chroma += hsv.chroma;
    moments->saturation += hsv.saturation;
    moments->value += hsv.value;
}

static void add_row(void *context, const uint32_t row[WORKING_WIDTH])
{
    sums_t *const sums = context;
    moments_t moments = sums->moments; /* here they fit into registers */
    for (uint32_t x = 0; x < WORKING_WIDTH; x += 2) {
        add_pixel(&moments, sums, row[x]);
        add_pixel(&moments, sums, row[x + 1]);
    }
    sums->moments = moments;
}

static void sum_bin(sums_t *sums, uint8_t bin, row_source_t *rows, void *image)
{
    const uint32_t first = first_grey(bin), after = first_grey(bin + 1u);
    *sums = (sums_t){.bin = bin,
                     .from = (first << METHOD_GREY_SHIFT) - GREY_HALF,
                     .span = (after - first) << METHOD_GREY_SHIFT};
    rows(image, add_row, sums);
    sums->count[bin] = WORKING_PIXELS;
    for (uint32_t other = 0; other < METHOD_GREY_BINS; other++)
        if (other != bin)
            sums->count[bin] -= sums->count[other];
}

static uint8_t fullest(const sums_t *sums)
{
    uint8_t fullest = 0;
    for (uint8_t bin = 1; bin < METHOD_GREY_BINS; bin++)
        if (sums->count[bin] > sums->count[fullest])
            fullest = bin;
    return fullest;
}

static void keep(background_t *background, const sums_t *sums)
{
    for (uint32_t bin = 0; bin < METHOD_GREY_BINS; bin++)
        background->bin_counts[bin] = (uint16_t)sums->count[bin];
    background->bin = sums->bin;
    background->hue_sum = sums->moments.hue;
    background->chroma_sum = sums->moments.chroma;
    background->saturation_sum = sums->moments.saturation;
    background->value_sum = sums->moments.value;
}

/* Length of the mean hue vector over the mean chroma, 0..255.  The length is
 * the projection on the mean hue: no square root. */
static uint8_t resultant(const background_t *b)
{
    const int64_t unit = METHOD_TRIG_UNIT;
    const int64_t along = (int64_t)b->hue_sum.x * hue_cos(b->hue) +
                          (int64_t)b->hue_sum.y * hue_sin(b->hue);
    const uint32_t length = (uint32_t)(along / (unit * unit));
    const uint32_t part = (510 * length + b->chroma_sum) / (2 * b->chroma_sum);
    return (uint8_t)(part < 255 ? part : 255);
}

void background_from_rows(background_t *background, row_source_t *rows,
                          void *image, uint8_t likely_bin)
{
    sums_t sums;
    memset(background, 0, sizeof *background);
    sum_bin(&sums, likely_bin, rows, image);
    if (fullest(&sums) != likely_bin)
        sum_bin(&sums, fullest(&sums), rows, image);
    keep(background, &sums);

    const uint32_t n = background->bin_counts[background->bin];
    background->saturation =
        (uint8_t)((2 * background->saturation_sum + n) / (2 * n));
    background->value = (uint8_t)((2 * background->value_sum + n) / (2 * n));
    background->share =
        (uint8_t)((510 * n + WORKING_PIXELS) / (2 * WORKING_PIXELS));
    if (!hue_of_vector(background->hue_sum, &background->hue))
        return;
    background->resultant = resultant(background);
    background->confidence =
        (uint8_t)((background->resultant * background->share + 127) / 255);
    background->meaningful = background->saturation >= METHOD_MIN_SATURATION &&
                             background->value >= METHOD_MIN_VALUE &&
                             background->resultant >= METHOD_MIN_RESULTANT;
}
