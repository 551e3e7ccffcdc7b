/* The golden vectors, stage by stage: one case a frame, one a sequence. */
#include "golden.h"

#include <stdio.h>

#include "fixture.h"
#include "suite.h"

static const golden_frame_t *golden;
static size_t sequence_at;
static whole_image_t image;
static background_t background;

/* `at` points to the bytes R G B of a whole image in golden_pixels. */
static void assert_stage(const char *stage, uint32_t at)
{
    static const char *const channel_name[3] = {"red", "green", "blue"};
    char message[80];
    for (uint32_t i = 0; i < WORKING_PIXELS; i++) {
        const uint32_t pixel = image.pixel[i];
        const uint32_t actual[3] = {pixel_red(pixel), pixel_green(pixel),
                                    pixel_blue(pixel)};
        for (uint32_t channel = 0; channel < 3; channel++) {
            const uint8_t expected = golden_pixels[at + 3 * i + channel];
            if (actual[channel] == expected)
                continue;
            snprintf(message, sizeof message, "%s: %s of pixel x %u, y %u",
                     stage, channel_name[channel], (unsigned)(i % 80),
                     (unsigned)(i / 80));
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected, actual[channel], message);
        }
    }
}

static void assert_background(const background_t *expected)
{
    const background_t *b = &background;
    TEST_ASSERT_EQUAL_UINT16_ARRAY_MESSAGE(expected->bin_counts, b->bin_counts,
                                           METHOD_GREY_BINS, "bin counts");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected->bin, b->bin, "bin");
    TEST_ASSERT_EQUAL_INT32_MESSAGE(expected->hue_sum.x, b->hue_sum.x, "hue x");
    TEST_ASSERT_EQUAL_INT32_MESSAGE(expected->hue_sum.y, b->hue_sum.y, "hue y");
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected->chroma_sum, b->chroma_sum,
                                     "chroma sum");
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected->saturation_sum,
                                     b->saturation_sum, "saturation sum");
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected->value_sum, b->value_sum,
                                     "value sum");
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(expected->hue, b->hue, "hue");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected->saturation, b->saturation,
                                    "saturation");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected->value, b->value, "value");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected->resultant, b->resultant,
                                    "resultant");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected->share, b->share, "share");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected->confidence, b->confidence,
                                    "confidence");
    TEST_ASSERT_TRUE_MESSAGE(expected->meaningful == b->meaningful,
                             "meaningful");
}

static void assert_background_rgb(rgb_t expected)
{
    const rgb_t rgb =
        rgb_from_hsv(background.hue, background.saturation, background.value);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected.red, rgb.red, "background red");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected.green, rgb.green,
                                    "background green");
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(expected.blue, rgb.blue, "background blue");
}

static void a_frame_gives_its_golden_values(void)
{
    const frame_t frame = {golden_pixels + golden->frame_at,
                           golden->frame_bytes,
                           golden->width,
                           golden->height,
                           golden->format,
                           0};
    TEST_ASSERT_TRUE_MESSAGE(frame_is_valid(&frame), "frame is refused");

    whole_image_working(&image, &frame);
    assert_stage("working image", golden->working_at);

    whole_image_smoothed(&image, &frame);
    assert_stage("smoothed image", golden->smoothed_at);

    for (uint8_t bin = 0; bin < METHOD_GREY_BINS; bin++) {
        whole_image_background(&background, &image, bin);
        assert_background(&golden->background);
    }
    assert_background_rgb(golden->background_rgb);

    const uint16_t hue =
        marker_hue(&background, golden->mapping, METHOD_FALLBACK_HUE);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(golden->marker_hue, hue, "marker hue");

    const led_settings_t led = dock_default_settings().led;
    uint16_t duties[3];
    led_duties(duties, hue, &led);
    TEST_ASSERT_EQUAL_UINT16_ARRAY_MESSAGE(golden->duties, duties, 3, "duties");
}

static void a_dock_given_the_frame_shows_its_golden_colour(void)
{
    static dock_t dock;
    const frame_t frame = {golden_pixels + golden->frame_at,
                           golden->frame_bytes,
                           golden->width,
                           golden->height,
                           golden->format,
                           0};
    dock_settings_t settings = dock_default_settings();
    settings.mapping = golden->mapping;
    dock_init(&dock, &settings);

    dock_frame(&dock, &frame, 0);

    uint16_t duties[3];
    dock_led_duties(&dock, duties, 0);
    TEST_ASSERT_EQUAL_UINT16(golden->marker_hue, dock.decision.steady.shown);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(golden->duties, duties, 3);
}

static void a_sequence_gives_its_golden_means(void)
{
    rolling_t rolling;
    char message[64];
    rolling_init(&rolling);
    size_t at = sequence_at;
    do {
        const golden_rolling_t *step = &golden_rolling[at];
        snprintf(message, sizeof message, "decision %u of the sequence",
                 (unsigned)(at - sequence_at));
        const uint16_t mean =
            rolling_add(&rolling, step->hue, step->now_ms, METHOD_WINDOW_MS);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(step->mean, mean, message);
        at++;
    } while (at < golden_rolling_count && !golden_rolling[at].first);
}

static void test_sequences_of_both_kinds_show_their_golden_hues(void)
{
    steady_t steady;
    char message[64];
    TEST_ASSERT_TRUE(golden_steady_count >= 100);
    for (size_t i = 0; i < golden_steady_count; i++) {
        const golden_steady_t *step = &golden_steady[i];
        if (step->first)
            steady_init(&steady);
        snprintf(message, sizeof message, "decision %u", (unsigned)i);
        steady_add(&steady, step->meaningful, step->hue, METHOD_WINDOW_MS,
                   step->now_ms);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(step->shown, steady.shown, message);
    }
}

static void test_led_settings_give_their_golden_duties(void)
{
    char message[64];
    for (size_t i = 0; i < golden_led_count; i++) {
        const golden_led_t *led = &golden_leds[i];
        uint16_t duties[3];
        snprintf(message, sizeof message, "vector %u, hue %u", (unsigned)i,
                 (unsigned)led->hue);
        led_duties(duties, led->hue, &led->led);
        TEST_ASSERT_EQUAL_UINT16_ARRAY_MESSAGE(led->duties, duties, 3, message);
    }
}

static void test_there_are_vectors_of_every_kind(void)
{
    TEST_ASSERT_TRUE(golden_frame_count >= 10);
    TEST_ASSERT_TRUE(golden_rolling_count >= 100);
    TEST_ASSERT_TRUE(golden_led_count >= 50);
}

/* What RUN_TEST does, under a name that is put together. */
static void run_named(UnityTestFunction test, const char *what,
                      const char *which, int line)
{
    char name[96];
    snprintf(name, sizeof name, "test_%s_%s", what, which);
    UnityDefaultTestRun(test, name, line);
}

static void run_tests(void)
{
    RUN_TEST(test_there_are_vectors_of_every_kind);
    for (size_t i = 0; i < golden_frame_count; i++) {
        golden = &golden_frames[i];
        run_named(a_frame_gives_its_golden_values, "frame", golden->name,
                  __LINE__);
        run_named(a_dock_given_the_frame_shows_its_golden_colour, "dock",
                  golden->name, __LINE__);
    }
    for (size_t i = 0; i < golden_rolling_count; i++) {
        char number[16];
        if (!golden_rolling[i].first)
            continue;
        sequence_at = i;
        snprintf(number, sizeof number, "%u", (unsigned)i);
        run_named(a_sequence_gives_its_golden_means, "rolling_from", number,
                  __LINE__);
    }
    RUN_TEST(test_sequences_of_both_kinds_show_their_golden_hues);
    RUN_TEST(test_led_settings_give_their_golden_duties);
}

SUITE(run_tests)
