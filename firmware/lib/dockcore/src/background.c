#include "background.h"

#include <string.h>

#include "hsv.h"

/* OpenCV's COLOR_RGB2GRAY, then five equal intervals. */
static inline uint32_t grey_bin(uint32_t pixel)
{
    const uint32_t grey = (METHOD_GREY_RED * pixel_red(pixel) +
                           METHOD_GREY_GREEN * pixel_green(pixel) +
                           METHOD_GREY_BLUE * pixel_blue(pixel) +
                           (1u << (METHOD_GREY_SHIFT - 1))) >>
                          METHOD_GREY_SHIFT;
    return grey * METHOD_GREY_BINS >> 8;
}

static void count_bins(background_t *background, working_image_t *image)
{
    uint32_t counts[METHOD_GREY_BINS] = {0};
    for (uint32_t i = 0; i < WORKING_PIXELS; i++) {
        const uint32_t bin = grey_bin(image->pixel[i]);
        image->pixel[i] |= bin << PIXEL_BIN_SHIFT;
        counts[bin]++;
    }
    for (uint8_t bin = 0; bin < METHOD_GREY_BINS; bin++) {
        background->bin_counts[bin] = (uint16_t)counts[bin];
        if (counts[bin] > counts[background->bin])
            background->bin = bin;
    }
}

static void sum_colours(background_t *background, const working_image_t *image)
{
    int32_t x = 0, y = 0;
    uint32_t chroma = 0, saturation = 0, value = 0;
    for (uint32_t i = 0; i < WORKING_PIXELS; i++) {
        const uint32_t pixel = image->pixel[i];
        if (pixel_bin(pixel) != background->bin)
            continue;
        const hsv_t hsv = hsv_from_rgb(pixel_red(pixel), pixel_green(pixel),
                                       pixel_blue(pixel));
        x += hsv.chroma * hue_cos(hsv.hue);
        y += hsv.chroma * hue_sin(hsv.hue);
        chroma += hsv.chroma;
        saturation += hsv.saturation;
        value += hsv.value;
    }
    background->hue_sum = (hue_vector_t){x, y};
    background->chroma_sum = chroma;
    background->saturation_sum = saturation;
    background->value_sum = value;
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

void background_from_image(background_t *background, working_image_t *image)
{
    memset(background, 0, sizeof *background);
    count_bins(background, image);
    sum_colours(background, image);

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
