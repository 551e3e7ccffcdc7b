#include "whole_image.h"

#include <string.h>

#include "smooth.h"
#include "working_image.h"

void whole_image_working(whole_image_t *image, const frame_t *frame)
{
    working_image_t read;
    working_image_open(&read, frame);
    for (uint32_t y = 0; y < WORKING_HEIGHT; y++)
        working_image_row(&read, y, image->pixel + y * WORKING_WIDTH);
}

static void append(void *context, const uint32_t row[WORKING_WIDTH])
{
    uint32_t **const next = context;
    memcpy(*next, row, WORKING_WIDTH * sizeof *row);
    *next += WORKING_WIDTH;
}

void whole_image_smoothed(whole_image_t *image, const frame_t *frame)
{
    smoothed_t smoothed;
    uint32_t *next = image->pixel;
    smoothed_open(&smoothed, frame);
    smoothed_rows(&smoothed, append, (void *)&next);
}

static void each_row(void *image, row_taker_t *take, void *context)
{
    const whole_image_t *whole = image;
    for (uint32_t y = 0; y < WORKING_HEIGHT; y++)
        take(context, whole->pixel + y * WORKING_WIDTH);
}

void whole_image_background(background_t *background, whole_image_t *image,
                            uint8_t likely_bin)
{
    background_from_rows(background, each_row, image, likely_bin);
}
