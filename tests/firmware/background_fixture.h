/* A background from an image of two colours. */
#ifndef BACKGROUND_FIXTURE_H
#define BACKGROUND_FIXTURE_H

#include <string.h>

#include "fixture.h"

#define GREY(value) pixel_pack(value, value, value)

static working_image_t image;
static background_t background;

/* Reads `image` into a struct full of rubbish. */
static inline void decide(void)
{
    memset(&background, 0xA5, sizeof background);
    background_from_image(&background, &image);
}

/* The first `count` pixels of one colour, the others of another. */
static inline void decide_on(uint32_t count, uint32_t pixel, uint32_t other)
{
    image_fill(&image, other);
    image_fill_part(&image, 0, count, pixel);
    decide();
}

#endif
