/* The short way of the dock camera's own frames. */
#include "qqvga.h"

#include <string.h>

#include "fixture.h"
#include "suite.h"

static whole_image_t image, expected;

/* The same frame two bytes on: at half a word. */
static frame_t shifted(const canvas_t *canvas)
{
    frame_t frame = canvas->frame;
    const canvas_t room = canvas_new(FRAME_RGB565, 160 * 120 + 1, 1);
    memcpy(room.bytes + 2, frame.bytes, frame.length);
    frame.bytes = room.bytes + 2;
    return frame;
}

static void test_the_cameras_frames_go_the_short_way(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB565, 160, 120);
    TEST_ASSERT_TRUE(qqvga_is_rgb565(&canvas.frame));
}

static void test_half_a_word_goes_the_long_way(void)
{
    /* Xtensa traps on a word that is not at a word's address. */
    const canvas_t canvas = canvas_new(FRAME_RGB565, 160, 120);
    const frame_t frame = shifted(&canvas);
    TEST_ASSERT_FALSE(qqvga_is_rgb565(&frame));
}

static void test_other_frames_go_the_long_way(void)
{
    const canvas_t other[3] = {canvas_new(FRAME_RGB888, 160, 120),
                               canvas_new(FRAME_RGB565, 162, 120),
                               canvas_new(FRAME_RGB565, 160, 121)};
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_FALSE(qqvga_is_rgb565(&other[i].frame));
}

static void test_both_ways_give_the_same_image(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB565, 160, 120);
    const frame_t frame = shifted(&canvas);

    whole_image_working(&expected, &frame);
    for (uint32_t y = 0; y < WORKING_HEIGHT; y++)
        qqvga_row(&canvas.frame, y, image.pixel + y * WORKING_WIDTH);

    assert_same_image(&expected, &image);
}

static void run_tests(void)
{
    RUN_TEST(test_the_cameras_frames_go_the_short_way);
    RUN_TEST(test_half_a_word_goes_the_long_way);
    RUN_TEST(test_other_frames_go_the_long_way);
    RUN_TEST(test_both_ways_give_the_same_image);
}

SUITE(run_tests)
