/* Frames and images for the suites. */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "dockcore.h"
#include "whole_image.h"

/* A frame that can be painted.  Its buffer is on the heap and exactly as long
 * as the frame, so that AddressSanitizer sees a read beyond either end. */
typedef struct {
    frame_t frame;
    uint8_t *bytes; /* frame.bytes, to write */
} canvas_t;

/* A pixel R G B as the format stores it: RGB565 0..31, 0..63, 0..31. */
typedef struct {
    uint32_t red, green, blue;
} colour_t;

/* All zero.  Freed after each test, or by canvas_free_all. */
canvas_t canvas_new(frame_format_t format, uint32_t width, uint32_t height);
canvas_t canvas_of(frame_format_t format, uint32_t width, uint32_t height,
                   colour_t colour);
canvas_t canvas_noise(frame_format_t format, uint32_t width, uint32_t height);
void canvas_free_all(void);

void canvas_set(const canvas_t *canvas, uint32_t x, uint32_t y,
                colour_t colour);
colour_t canvas_get(const canvas_t *canvas, uint32_t x, uint32_t y);

/* Full scale of red and blue, and of green. */
uint32_t full_red(frame_format_t format);
uint32_t full_green(frame_format_t format);

/* Mean on the scale 0..255 by plain division, halves up. */
uint32_t mean_by_division(uint64_t sum, uint64_t count, uint64_t full);

/* The same numbers in every run. */
uint32_t noise(uint32_t *state);

/* An RGB888 frame of the working size that is read as this image. */
canvas_t canvas_of_image(const whole_image_t *image);

void image_fill(whole_image_t *image, uint32_t pixel);

/* `count` pixels from number `first` on. */
void image_fill_part(whole_image_t *image, uint32_t first, uint32_t count,
                     uint32_t pixel);

/* Fails with the first pixel that differs. */
void assert_same_image(const whole_image_t *expected,
                       const whole_image_t *actual);

#endif
