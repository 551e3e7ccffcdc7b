#include "background.h"

#include <string.h>

#include "hsv.h"

_Static_assert(METHOD_GREY_RED + METHOD_GREY_GREEN + METHOD_GREY_BLUE ==
                   1 << METHOD_GREY_SHIFT,
               "grey_bin leaves the product with blue out");

/* OpenCV's COLOR_RGB2GRAY, then five equal intervals.  The three weights add up
 * to 1, so that two products are enough. */
static inline uint32_t grey_bin(uint32_t red, uint32_t green, uint32_t blue)
{
    const int32_t above_blue = METHOD_GREY_RED * (int32_t)(red - blue) +
                               METHOD_GREY_GREEN * (int32_t)(green - blue) +
                               (1 << (METHOD_GREY_SHIFT - 1));
    const uint32_t grey = blue + (uint32_t)(above_blue >> METHOD_GREY_SHIFT);
    return grey * METHOD_GREY_BINS >> 8;
}

/* The pixels of one bin. */
typedef struct {
    uint32_t count;
    hue_vector_t hue;
    uint32_t chroma, saturation, value;
} sums_t;

static void sum_bins(sums_t sums[METHOD_GREY_BINS],
                     const working_image_t *image)
{
    for (uint32_t i = 0; i < WORKING_PIXELS; i++) {
        const uint32_t pixel = image->pixel[i];
        const uint32_t red = pixel_red(pixel);
        const uint32_t green = pixel_green(pixel);
        const uint32_t blue = pixel_blue(pixel);
        const hsv_t hsv = hsv_from_rgb(red, green, blue);
        const int32_t chroma = (int32_t)hsv.chroma;
        sums_t *sum = &sums[grey_bin(red, green, blue)];
        sum->count++;
        const int16_t *sine = METHOD_SINE + hsv.hue;
        sum->hue.x += chroma * sine[METHOD_HUE_RANGE / 4];
        sum->hue.y += chroma * sine[0];
        sum->chroma += hsv.chroma;
        sum->saturation += hsv.saturation;
        sum->value += hsv.value;
    }
}

static void keep_fullest(background_t *background, const sums_t *sums)
{
    for (uint8_t bin = 0; bin < METHOD_GREY_BINS; bin++) {
        background->bin_counts[bin] = (uint16_t)sums[bin].count;
        if (sums[bin].count > sums[background->bin].count)
            background->bin = bin;
    }
    const sums_t *fullest = &sums[background->bin];
    background->hue_sum = fullest->hue;
    background->chroma_sum = fullest->chroma;
    background->saturation_sum = fullest->saturation;
    background->value_sum = fullest->value;
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

void background_from_image(background_t *background,
                           const working_image_t *image)
{
    sums_t sums[METHOD_GREY_BINS] = {{0}};
    memset(background, 0, sizeof *background);
    sum_bins(sums, image);
    keep_fullest(background, sums);

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
