#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { CANVASES = 8 };

static uint8_t *buffers[CANVASES];
static size_t buffer_count;

void canvas_free_all(void)
{
    while (buffer_count > 0)
        free(buffers[--buffer_count]);
}

/* Unity calls these before and after each test. */
void setUp(void)
{
}

void tearDown(void)
{
    canvas_free_all();
}

canvas_t canvas_new(frame_format_t format, uint32_t width, uint32_t height)
{
    const size_t length = (format == FRAME_RGB565 ? 2u : 3u) * width * height;
    TEST_ASSERT_TRUE_MESSAGE(buffer_count < CANVASES, "too many canvases");
    uint8_t *bytes = calloc(length, 1);
    TEST_ASSERT_NOT_NULL(bytes);
    buffers[buffer_count++] = bytes;
    return (canvas_t){
        {bytes, length, (uint16_t)width, (uint16_t)height, format, 0}, bytes};
}

canvas_t canvas_of(frame_format_t format, uint32_t width, uint32_t height,
                   colour_t colour)
{
    const canvas_t canvas = canvas_new(format, width, height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            canvas_set(&canvas, x, y, colour);
    return canvas;
}

canvas_t canvas_noise(frame_format_t format, uint32_t width, uint32_t height)
{
    const canvas_t canvas = canvas_new(format, width, height);
    uint32_t state = width << 16 | height;
    for (size_t i = 0; i < canvas.frame.length; i++)
        canvas.bytes[i] = (uint8_t)noise(&state);
    return canvas;
}

void canvas_set(const canvas_t *canvas, uint32_t x, uint32_t y, colour_t colour)
{
    const size_t at = (size_t)y * canvas->frame.width + x;
    if (canvas->frame.format == FRAME_RGB565) {
        const uint32_t word =
            colour.red << 11 | colour.green << 5 | colour.blue;
        canvas->bytes[2 * at] = (uint8_t)(word >> 8);
        canvas->bytes[2 * at + 1] = (uint8_t)word;
        return;
    }
    canvas->bytes[3 * at] = (uint8_t)colour.red;
    canvas->bytes[3 * at + 1] = (uint8_t)colour.green;
    canvas->bytes[3 * at + 2] = (uint8_t)colour.blue;
}

colour_t canvas_get(const canvas_t *canvas, uint32_t x, uint32_t y)
{
    const size_t at = (size_t)y * canvas->frame.width + x;
    const uint8_t *bytes = canvas->bytes;
    if (canvas->frame.format == FRAME_RGB565) {
        const uint32_t word = 256u * bytes[2 * at] + bytes[2 * at + 1];
        return (colour_t){word >> 11, word >> 5 & 63, word & 31};
    }
    return (colour_t){bytes[3 * at], bytes[3 * at + 1], bytes[3 * at + 2]};
}

uint32_t full_red(frame_format_t format)
{
    return format == FRAME_RGB565 ? 31 : 255;
}

uint32_t full_green(frame_format_t format)
{
    return format == FRAME_RGB565 ? 63 : 255;
}

uint32_t mean_by_division(uint64_t sum, uint64_t count, uint64_t full)
{
    return (uint32_t)((510 * sum + full * count) / (2 * full * count));
}

uint32_t noise(uint32_t *state)
{
    *state = *state * UINT32_C(1664525) + UINT32_C(1013904223);
    return *state >> 16;
}

canvas_t canvas_of_image(const whole_image_t *image)
{
    const canvas_t canvas =
        canvas_new(FRAME_RGB888, WORKING_WIDTH, WORKING_HEIGHT);
    for (uint32_t i = 0; i < WORKING_PIXELS; i++)
        canvas_set(&canvas, i % WORKING_WIDTH, i / WORKING_WIDTH,
                   (colour_t){pixel_red(image->pixel[i]),
                              pixel_green(image->pixel[i]),
                              pixel_blue(image->pixel[i])});
    return canvas;
}

void image_fill_part(whole_image_t *image, uint32_t first, uint32_t count,
                     uint32_t pixel)
{
    for (uint32_t i = first; i < first + count; i++)
        image->pixel[i] = pixel;
}

void image_fill(whole_image_t *image, uint32_t pixel)
{
    image_fill_part(image, 0, WORKING_PIXELS, pixel);
}

void assert_same_image(const whole_image_t *expected,
                       const whole_image_t *actual)
{
    char message[64];
    for (uint32_t i = 0; i < WORKING_PIXELS; i++) {
        if (expected->pixel[i] == actual->pixel[i])
            continue;
        snprintf(message, sizeof message, "pixel x %u, y %u",
                 (unsigned)(i % METHOD_WORKING_WIDTH),
                 (unsigned)(i / METHOD_WORKING_WIDTH));
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected->pixel[i], actual->pixel[i],
                                        message);
    }
}
