/* Hues of pixels on the hexcone, and sums over the pixels of the water: the
 * colour decision's integers, as docs/method.md has them.  Nothing here
 * allocates memory or keeps anything. */
#ifndef HUE_H
#define HUE_H

#include <stdint.h>

/* Tables that divide, and their fixed points. */
typedef struct {
    int32_t range;            /* hues of a turn */
    int32_t shift;            /* bits behind the point in the next table */
    const int32_t *by_chroma; /* 256: a sixth of a turn over each chroma */
    int32_t saturation_shift; /* bits behind the point in the next table */
    const int32_t *by_value;  /* 256: 255 over each value */
} hue_tables_t;

/* Of the pixels of one grey interval: how many they are, and sums of chroma
 * times cosine and sine of the hue, of chroma, of saturation and of value. */
typedef struct {
    int64_t count, x, y, chroma, saturation, value;
} hue_sums_t;

/* Hue, 0 to range - 1, saturation, value and chroma, 0 to 255, of some pixels.
 *
 * rgb: 3 bytes a pixel.
 * hsvc: receives count hues, then as many saturations, values and chromas. */
void hue_of_pixels(const hue_tables_t *tables, const uint8_t *rgb,
                   int32_t count, int32_t *hsvc);

/* Adds up the pixels of each grey interval.
 *
 * sine: of each hue from 0 on, a turn and a quarter of them.
 * grey: of each pixel.
 * bins: equal intervals that its 256 values are divided into.
 * sums: those of each interval, dark to bright, are added to these. */
void hue_sum(const hue_tables_t *tables, const int32_t *sine,
             const uint8_t *rgb, const uint8_t *grey, int32_t count,
             int32_t bins, hue_sums_t *sums);

#endif
