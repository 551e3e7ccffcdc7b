/* Which frames are accepted: frame_is_valid. */
#include "frame.h"
#include "suite.h"

static _Alignas(2) uint8_t bytes[2];

/* No test here reads the pixels: the buffer can be shorter than the frame. */
static frame_t frame(frame_format_t format, uint16_t width, uint16_t height,
                     size_t length)
{
    return (frame_t){bytes, length, width, height, format, 0};
}

static void assert_valid(frame_t candidate)
{
    TEST_ASSERT_TRUE(frame_is_valid(&candidate));
}

static void assert_refused(frame_t candidate)
{
    TEST_ASSERT_FALSE(frame_is_valid(&candidate));
}

static void test_rgb565_has_two_bytes_a_pixel(void)
{
    assert_valid(frame(FRAME_RGB565, 160, 120, 38400));
}

static void test_rgb888_has_three_bytes_a_pixel(void)
{
    assert_valid(frame(FRAME_RGB888, 160, 120, 57600));
}

static void test_one_pixel_is_a_frame(void)
{
    assert_valid(frame(FRAME_RGB565, 1, 1, 2));
    assert_valid(frame(FRAME_RGB888, 1, 1, 3));
}

static void test_the_length_of_the_other_format_is_refused(void)
{
    assert_refused(frame(FRAME_RGB565, 160, 120, 57600));
    assert_refused(frame(FRAME_RGB888, 160, 120, 38400));
}

static void test_a_byte_too_few_is_refused(void)
{
    assert_refused(frame(FRAME_RGB565, 160, 120, 38399));
    assert_refused(frame(FRAME_RGB888, 160, 120, 57599));
}

static void test_a_byte_too_many_is_refused(void)
{
    assert_refused(frame(FRAME_RGB565, 160, 120, 38401));
    assert_refused(frame(FRAME_RGB888, 160, 120, 57601));
}

static void test_an_empty_buffer_is_refused(void)
{
    assert_refused(frame(FRAME_RGB565, 160, 120, 0));
}

static void test_a_frame_without_width_is_refused(void)
{
    assert_refused(frame(FRAME_RGB888, 0, 120, 0));
}

static void test_a_frame_without_height_is_refused(void)
{
    assert_refused(frame(FRAME_RGB888, 160, 0, 0));
}

static void test_the_largest_frame_is_accepted(void)
{
    assert_valid(frame(FRAME_RGB565, 5120, 3840, 39321600));
    assert_valid(frame(FRAME_RGB888, 5120, 3840, 58982400));
}

static void test_a_column_beyond_the_largest_is_refused(void)
{
    assert_valid(frame(FRAME_RGB565, 5120, 1, 10240));
    assert_refused(frame(FRAME_RGB565, 5121, 1, 10242));
    assert_refused(frame(FRAME_RGB565, 65535, 1, 131070));
}

static void test_a_row_beyond_the_largest_is_refused(void)
{
    assert_valid(frame(FRAME_RGB565, 1, 3840, 7680));
    assert_refused(frame(FRAME_RGB565, 1, 3841, 7682));
    assert_refused(frame(FRAME_RGB565, 1, 65535, 131070));
}

static void test_a_format_without_a_name_is_refused(void)
{
    assert_refused(frame((frame_format_t)2, 1, 1, 2));
    assert_refused(frame((frame_format_t)2, 1, 1, 3));
    assert_refused(frame((frame_format_t)2, 1, 1, 0));
    assert_refused(frame((frame_format_t)255, 1, 1, 2));
}

static void test_a_frame_without_bytes_is_refused(void)
{
    frame_t nothing = frame(FRAME_RGB888, 1, 1, 3);
    nothing.bytes = NULL;

    assert_refused(nothing);
}

static void test_rgb565_at_an_odd_address_is_refused(void)
{
    frame_t shifted = frame(FRAME_RGB565, 1, 1, 2);
    shifted.bytes = bytes + 1;

    assert_refused(shifted);
}

static void test_rgb888_may_lie_at_an_odd_address(void)
{
    frame_t shifted = frame(FRAME_RGB888, 1, 1, 3);
    shifted.bytes = bytes + 1;

    assert_valid(shifted);
}

static void run_tests(void)
{
    RUN_TEST(test_rgb565_has_two_bytes_a_pixel);
    RUN_TEST(test_rgb888_has_three_bytes_a_pixel);
    RUN_TEST(test_one_pixel_is_a_frame);
    RUN_TEST(test_the_length_of_the_other_format_is_refused);
    RUN_TEST(test_a_byte_too_few_is_refused);
    RUN_TEST(test_a_byte_too_many_is_refused);
    RUN_TEST(test_an_empty_buffer_is_refused);
    RUN_TEST(test_a_frame_without_width_is_refused);
    RUN_TEST(test_a_frame_without_height_is_refused);
    RUN_TEST(test_the_largest_frame_is_accepted);
    RUN_TEST(test_a_column_beyond_the_largest_is_refused);
    RUN_TEST(test_a_row_beyond_the_largest_is_refused);
    RUN_TEST(test_a_format_without_a_name_is_refused);
    RUN_TEST(test_a_frame_without_bytes_is_refused);
    RUN_TEST(test_rgb565_at_an_odd_address_is_refused);
    RUN_TEST(test_rgb888_may_lie_at_an_odd_address);
}

SUITE(run_tests)
