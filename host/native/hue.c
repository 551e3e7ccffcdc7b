#include "hue.h"

typedef struct {
    int32_t hue, saturation, value, chroma;
} hsvc_t;

/* A number times its table's entry, rounded to the table's unit, halves up. */
static inline int64_t scaled(int32_t number, int32_t entry, int32_t shift)
{
    return (int64_t)number * entry + ((int64_t)1 << (shift - 1));
}

static inline hsvc_t hsvc_of(const hue_tables_t *tables, const uint8_t *rgb)
{
    const int32_t r = rgb[0], g = rgb[1], b = rgb[2];
    const int32_t high = r > g ? r : g, low = r < g ? r : g;
    const int32_t value = high > b ? high : b;
    const int32_t chroma = value - (low < b ? low : b);
    /* From red, in sixths of a turn times the chroma: green lies two sixths
     * on, and blue four. */
    int32_t distance = r - g + 4 * chroma;
    distance = value == g ? b - r + 2 * chroma : distance;
    distance = value == r ? g - b : distance;
    int64_t hue = scaled(distance, tables->by_chroma[chroma], tables->shift);
    /* What lies before red is at the end of the turn. */
    hue += hue < 0 ? (int64_t)tables->range << tables->shift : 0;
    const int64_t saturation =
        scaled(chroma, tables->by_value[value], tables->saturation_shift);
    return (hsvc_t){(int32_t)(hue >> tables->shift),
                    (int32_t)(saturation >> tables->saturation_shift), value,
                    chroma};
}

void hue_of_pixels(const hue_tables_t *tables, const uint8_t *rgb,
                   int32_t count, int32_t *hsvc)
{
    for (int32_t i = 0; i < count; i++, rgb += 3, hsvc++) {
        const hsvc_t pixel = hsvc_of(tables, rgb);
        hsvc[0] = pixel.hue;
        hsvc[count] = pixel.saturation;
        hsvc[2 * count] = pixel.value;
        hsvc[3 * count] = pixel.chroma;
    }
}

void hue_sum(const hue_tables_t *tables, const int32_t *sine,
             const uint8_t *rgb, const uint8_t *grey, int32_t count,
             int32_t bins, hue_sums_t *sums)
{
    const int32_t *cosine = sine + tables->range / 4;
    for (int32_t i = 0; i < count; i++, rgb += 3) {
        const hsvc_t pixel = hsvc_of(tables, rgb);
        hue_sums_t *bin = &sums[grey[i] * bins >> 8];
        bin->count++;
        bin->x += pixel.chroma * cosine[pixel.hue];
        bin->y += pixel.chroma * sine[pixel.hue];
        bin->chroma += pixel.chroma;
        bin->saturation += pixel.saturation;
        bin->value += pixel.value;
    }
}
