#include "vectors.h"

#include "check.h"
#include "pixel.h"
#include "whole_image.h"

frame_t golden_frame(const golden_frame_t *golden)
{
    return (frame_t){golden_pixels + golden->frame_at,
                     golden->frame_bytes,
                     golden->width,
                     golden->height,
                     golden->format,
                     0};
}

dock_settings_t golden_settings(const golden_frame_t *golden)
{
    dock_settings_t settings = dock_default_settings();
    settings.mapping = golden->mapping;
    return settings;
}

/* The channels with the bits above them: what does not belong there shows. */
static void check_image(const char *stage, const uint8_t *expected,
                        const whole_image_t *image)
{
    for (uint32_t i = 0; i < WORKING_PIXELS; i++, expected += 3) {
        const uint32_t pixel = image->pixel[i];
        check_value(stage, 3 * i, expected[0], pixel >> PIXEL_RED_SHIFT);
        check_value(stage, 3 * i + 1, expected[1],
                    pixel >> PIXEL_GREEN_SHIFT & 0x3FF);
        check_value(stage, 3 * i + 2, expected[2], pixel & 0x3FF);
    }
}

static void check_background(const background_t *expected,
                             const background_t *got)
{
    for (uint32_t i = 0; i < METHOD_GREY_BINS; i++)
        check_value("bin_counts", i, expected->bin_counts[i],
                    got->bin_counts[i]);
    check_value("bin", 0, expected->bin, got->bin);
    check_value("hue_sum", 0, expected->hue_sum.x, got->hue_sum.x);
    check_value("hue_sum", 1, expected->hue_sum.y, got->hue_sum.y);
    check_value("chroma_sum", 0, expected->chroma_sum, got->chroma_sum);
    check_value("saturation_sum", 0, expected->saturation_sum,
                got->saturation_sum);
    check_value("value_sum", 0, expected->value_sum, got->value_sum);
    check_value("hue", 0, expected->hue, got->hue);
    check_value("saturation", 0, expected->saturation, got->saturation);
    check_value("value", 0, expected->value, got->value);
    check_value("resultant", 0, expected->resultant, got->resultant);
    check_value("share", 0, expected->share, got->share);
    check_value("confidence", 0, expected->confidence, got->confidence);
    check_value("meaningful", 0, expected->meaningful, got->meaningful);
}

static void check_colour(const char *stage, const uint8_t expected[3],
                         rgb_t got)
{
    check_value(stage, 0, expected[0], got.red);
    check_value(stage, 1, expected[1], got.green);
    check_value(stage, 2, expected[2], got.blue);
}

static void check_duties(const uint16_t expected[3], const uint16_t got[3])
{
    for (uint32_t i = 0; i < 3; i++)
        check_value("duties", i, expected[i], got[i]);
}

static void load_image(whole_image_t *image, const uint8_t *rgb)
{
    for (uint32_t i = 0; i < WORKING_PIXELS; i++, rgb += 3)
        image->pixel[i] = pixel_pack(rgb[0], rgb[1], rgb[2]);
}

/* The golden working image as a frame of its own size, which is read as it is.
 */
static frame_t working_frame(const golden_frame_t *golden)
{
    return (frame_t){golden_pixels + golden->working_at,
                     3 * WORKING_PIXELS,
                     WORKING_WIDTH,
                     WORKING_HEIGHT,
                     FRAME_RGB888,
                     0};
}

/* Each stage starts from golden values: a fault shows in its own stage only. */
static void check_stages(const golden_frame_t *golden)
{
    static whole_image_t image;
    const frame_t frame = golden_frame(golden);
    check_begin("stages", golden->name, 0);

    check_value("frame_is_valid", 0, true, frame_is_valid(&frame));
    whole_image_working(&image, &frame);
    check_image("working", golden_pixels + golden->working_at, &image);

    const frame_t working = working_frame(golden);
    whole_image_smoothed(&image, &working);
    check_image("smoothed", golden_pixels + golden->smoothed_at, &image);

    load_image(&image, golden_pixels + golden->smoothed_at);
    background_t background;
    for (uint8_t bin = 0; bin < METHOD_GREY_BINS; bin++) {
        whole_image_background(&background, &image, bin);
        check_background(&golden->background, &background);
    }

    const background_t *b = &golden->background;
    const rgb_t *rgb = &golden->background_rgb;
    check_colour("background_rgb", (uint8_t[]){rgb->red, rgb->green, rgb->blue},
                 rgb_from_hsv(b->hue, b->saturation, b->value));

    const dock_settings_t settings = golden_settings(golden);
    check_value("marker_hue", 0, golden->marker_hue,
                marker_hue(b, settings.mapping, settings.fallback_hue));
    uint16_t duties[3];
    led_duties(duties, golden->marker_hue, &settings.led);
    check_duties(golden->duties, duties);
    check_end();
}

/* The same through the dock, each stage fed by the one before. */
static void check_dock(const golden_frame_t *golden)
{
    static dock_t dock;
    const frame_t frame = golden_frame(golden);
    const dock_settings_t settings = golden_settings(golden);
    uint16_t duties[3];
    check_begin("dock", golden->name, 0);

    dock_init(&dock, &settings);
    dock_frame(&dock, &frame, 0);
    dock_led_duties(&dock, duties, 0);
    check_background(&golden->background, &dock.decision.background);
    check_value("decided_hue", 0, golden->marker_hue,
                dock.decision.decided_hue);
    check_value("marker_hue", 0, golden->marker_hue,
                dock.decision.steady.shown);
    check_value("decided", 0, true, dock.decision.decided);
    check_value("frames", 0, 1, dock.decision.frames);
    check_value("camera_faults", 0, 0, dock.camera_faults);
    check_value("frame_faults", 0, 0, dock.decision.frame_faults);
    check_duties(golden->duties, duties);
    check_end();
}

void check_frames(void)
{
    for (size_t i = 0; i < golden_frame_count; i++) {
        check_stages(&golden_frames[i]);
        check_dock(&golden_frames[i]);
    }
}

/* A vector is a whole sequence, from one empty window to the next. */
void check_rolling(void)
{
    static rolling_t rolling;
    uint32_t sequences = 0, step = 0;
    for (size_t i = 0; i < golden_rolling_count; i++, step++) {
        const golden_rolling_t *golden = &golden_rolling[i];
        if (golden->first) {
            if (i > 0)
                check_end();
            check_begin("rolling", NULL, sequences++);
            rolling_init(&rolling);
            step = 0;
        }
        check_value("mean", step, golden->mean,
                    rolling_add(&rolling, golden->hue, golden->now_ms,
                                METHOD_WINDOW_MS));
    }
    if (sequences > 0)
        check_end();
}

void check_steady(void)
{
    static steady_t steady;
    uint32_t sequences = 0, step = 0;
    for (size_t i = 0; i < golden_steady_count; i++, step++) {
        const golden_steady_t *golden = &golden_steady[i];
        if (golden->first) {
            if (i > 0)
                check_end();
            check_begin("steady", NULL, sequences++);
            steady_init(&steady);
            step = 0;
        }
        steady_add(&steady, golden->meaningful, golden->hue, METHOD_WINDOW_MS,
                   golden->now_ms);
        check_value("shown", step, golden->shown, steady.shown);
    }
    if (sequences > 0)
        check_end();
}

void check_leds(void)
{
    for (uint32_t i = 0; i < golden_led_count; i++) {
        const golden_led_t *golden = &golden_leds[i];
        uint16_t duties[3];
        check_begin("led", NULL, i);
        led_duties(duties, golden->hue, &golden->led);
        check_duties(golden->duties, duties);
        check_end();
    }
}

void check_mappings(void)
{
    for (uint8_t mapping = 0; mapping < METHOD_MAPPING_COUNT; mapping++) {
        check_begin("mapping", NULL, mapping);
        for (uint16_t hue = 0; hue < METHOD_HUE_RANGE; hue++) {
            const background_t water = {.hue = hue, .meaningful = true};
            check_value("marker_hue", hue, golden_marker_hues[mapping][hue],
                        marker_hue(&water, mapping, METHOD_FALLBACK_HUE));
        }
        check_end();
    }
}
