/* A camera frame as the caller owns it: pixels, size, format. */
#ifndef FRAME_H
#define FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    FRAME_RGB565, /* big-endian, two bytes a pixel, as the OV2640 delivers it */
    FRAME_RGB888, /* red, green, blue, a byte each */
} frame_format_t;

typedef struct {
    const uint8_t
        *bytes;      /* rows from the top, no padding; RGB565: even address */
    size_t length;   /* bytes behind `bytes` */
    uint16_t width;  /* pixels, 1..METHOD_MAX_FRAME_WIDTH */
    uint16_t height; /* pixels, 1..METHOD_MAX_FRAME_HEIGHT */
    frame_format_t format;
    uint32_t
        age_ms; /* since the first of its light was gathered; 0: just now */
} frame_t;

/* True where the frame can be read: known format, size in range, length equal
 * to what the size needs, address aligned. */
bool frame_is_valid(const frame_t *frame);

#endif
