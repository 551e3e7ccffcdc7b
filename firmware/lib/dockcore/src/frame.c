#include "frame.h"

#include "method.h"

static size_t bytes_per_pixel(frame_format_t format)
{
    switch (format) {
    case FRAME_RGB565:
        return 2;
    case FRAME_RGB888:
        return 3;
    }
    return 0; /* a value from outside that names no format */
}

bool frame_is_valid(const frame_t *frame)
{
    const size_t pixel = bytes_per_pixel(frame->format);
    if (frame->bytes == NULL || pixel == 0)
        return false;
    if (frame->width == 0 || frame->width > METHOD_MAX_FRAME_WIDTH ||
        frame->height == 0 || frame->height > METHOD_MAX_FRAME_HEIGHT)
        return false;
    if (frame->format == FRAME_RGB565 && ((uintptr_t)frame->bytes & 1) != 0)
        return false;
    return frame->length == pixel * frame->width * frame->height;
}
