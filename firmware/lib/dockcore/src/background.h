/* The water's colour: the fullest grey interval and the mean of its pixels. */
#ifndef BACKGROUND_H
#define BACKGROUND_H

#include <stdbool.h>
#include <stdint.h>

#include "hue.h"
#include "smooth.h"

typedef struct {
    uint16_t bin_counts[METHOD_GREY_BINS]; /* pixels, dark to bright */
    uint8_t bin;          /* the fullest; of equals the darker */
    hue_vector_t hue_sum; /* weighted by chroma */
    uint32_t chroma_sum, saturation_sum, value_sum;
    uint16_t hue;       /* circular mean; 0 where the vector is zero */
    uint8_t saturation; /* arithmetic mean, 0..255 */
    uint8_t value;      /* arithmetic mean, 0..255 */
    uint8_t resultant;  /* 255: all of one hue, 0: hues cancel out */
    uint8_t share;      /* of the image, 255: all of it */
    uint8_t confidence; /* resultant * share, 255: certain */
    bool meaningful;    /* false: grey water, night or a mixture: no hue */
} background_t;

/* Of a smoothed image.  `likely_bin`, 0..METHOD_GREY_BINS - 1, changes nothing
 * but the time it takes: the rows are read once where it is the fullest, as it
 * mostly is if it was so in the frame before, and else twice. */
void background_from_rows(background_t *background, row_source_t *rows,
                          void *image, uint8_t likely_bin);

#endif
