/* Golden vectors of the colour decision, shared by every target; the data is
 * generated (golden.c, shared/vectors/frames.bin). */
#ifndef GOLDEN_H
#define GOLDEN_H

#include "dockcore.h"

typedef struct {
    const char *name;
    frame_format_t format;
    uint16_t width, height;
    uint8_t mapping;
    uint32_t frame_at, frame_bytes;   /* in golden_pixels */
    uint32_t working_at, smoothed_at; /* WORKING_PIXELS * 3 bytes, R G B */
    background_t background;
    rgb_t background_rgb;
    uint16_t marker_hue;
    uint16_t duties[3]; /* with the default LED settings */
} golden_frame_t;

typedef struct {
    bool first; /* of a sequence: start with an empty window */
    uint32_t now_ms;
    uint16_t hue;
    uint16_t mean;
} golden_rolling_t;

typedef struct {
    bool first; /* of a sequence: nothing was decided before */
    uint32_t now_ms;
    bool meaningful;
    uint16_t hue;
    uint16_t shown;
} golden_steady_t;

typedef struct {
    uint16_t hue;
    led_settings_t led;
    uint16_t duties[3];
} golden_led_t;

extern const uint8_t golden_pixels[];
extern const golden_frame_t golden_frames[];
extern const size_t golden_frame_count;
extern const golden_rolling_t golden_rolling[];
extern const size_t golden_rolling_count;
extern const golden_steady_t golden_steady[];
extern const size_t golden_steady_count;
extern const golden_led_t golden_leds[];
extern const size_t golden_led_count;
/* Of every mapping for water of every hue. */
extern const uint16_t golden_marker_hues[METHOD_MAPPING_COUNT]
                                        [METHOD_HUE_RANGE];

#endif
