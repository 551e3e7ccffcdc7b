/* A background from an image of two colours. */
#ifndef BACKGROUND_FIXTURE_H
#define BACKGROUND_FIXTURE_H

#include <string.h>

#include "fixture.h"
#include "suite.h"

#define GREY(value) pixel_pack(value, value, value)

static whole_image_t image;
static background_t background;

/* Reads `image` into a struct full of rubbish; which bin is thought likely must
 * not matter. */
static inline void decide(void)
{
    memset(&background, 0xA5, sizeof background);
    whole_image_background(&background, &image, 0);
    for (uint8_t bin = 1; bin < METHOD_GREY_BINS; bin++) {
        background_t other;
        memset(&other, 0x5A, sizeof other);
        whole_image_background(&other, &image, bin);
        TEST_ASSERT_EQUAL_MEMORY(&background, &other, sizeof other);
    }
}

/* The first `count` pixels of one colour, the others of another. */
static inline void decide_on(uint32_t count, uint32_t pixel, uint32_t other)
{
    image_fill(&image, other);
    image_fill_part(&image, 0, count, pixel);
    decide();
}

#endif
