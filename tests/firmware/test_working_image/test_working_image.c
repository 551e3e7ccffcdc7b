/* From a frame of any size to 80 x 60: which pixels a cell averages. */
#include <string.h>

#include "fixture.h"
#include "suite.h"

static whole_image_t image, expected;

/* A cell by the documented rule: plain loops and one division. */
static uint32_t cell(const canvas_t *canvas, uint32_t cx, uint32_t cy)
{
    const uint32_t width = canvas->frame.width, height = canvas->frame.height;
    const uint32_t left = cx * width / 80, top = cy * height / 60;
    uint32_t right = (cx + 1) * width / 80, bottom = (cy + 1) * height / 60;
    right = right > left ? right : left + 1;
    bottom = bottom > top ? bottom : top + 1;
    colour_t sum = {0, 0, 0};
    for (uint32_t y = top; y < bottom; y++) {
        for (uint32_t x = left; x < right; x++) {
            const colour_t pixel = canvas_get(canvas, x, y);
            sum.red += pixel.red;
            sum.green += pixel.green;
            sum.blue += pixel.blue;
        }
    }
    const uint32_t count = (right - left) * (bottom - top);
    const frame_format_t format = canvas->frame.format;
    return pixel_pack(mean_by_division(sum.red, count, full_red(format)),
                      mean_by_division(sum.green, count, full_green(format)),
                      mean_by_division(sum.blue, count, full_red(format)));
}

static void assert_cells(const canvas_t *canvas)
{
    for (uint32_t i = 0; i < WORKING_PIXELS; i++)
        expected.pixel[i] = cell(canvas, i % 80, i / 80);

    whole_image_working(&image, &canvas->frame);

    assert_same_image(&expected, &image);
}

static void assert_size(uint32_t width, uint32_t height)
{
    const canvas_t rgb565 = canvas_noise(FRAME_RGB565, width, height);
    assert_cells(&rgb565);
    const canvas_t rgb888 = canvas_noise(FRAME_RGB888, width, height);
    assert_cells(&rgb888);
    canvas_free_all();
}

static void test_rgb888_of_the_working_size_is_copied(void)
{
    const canvas_t canvas = canvas_noise(FRAME_RGB888, 80, 60);
    for (uint32_t i = 0; i < WORKING_PIXELS; i++)
        expected.pixel[i] =
            pixel_pack(canvas.bytes[3 * i], canvas.bytes[3 * i + 1],
                       canvas.bytes[3 * i + 2]);

    whole_image_working(&image, &canvas.frame);

    assert_same_image(&expected, &image);
}

static void test_qqvga_is_averaged_by_2_x_2(void)
{
    assert_size(160, 120);
}

static void test_qvga_is_averaged_by_4_x_4(void)
{
    assert_size(320, 240);
}

static void test_vga_is_averaged_by_8_x_8(void)
{
    assert_size(640, 480);
}

static void test_svga_is_averaged_by_10_x_10(void)
{
    assert_size(800, 600);
}

static void test_720p_is_averaged_by_16_x_12(void)
{
    assert_size(1280, 720);
}

static void test_uxga_is_averaged_by_20_x_20(void)
{
    assert_size(1600, 1200);
}

static void test_a_size_that_is_no_multiple_is_shared_out(void)
{
    assert_size(163, 127);
    assert_size(400, 296);
    assert_size(1024, 768);
    assert_size(1281, 721);
}

static void test_a_size_one_off_a_multiple_is_shared_out(void)
{
    for (uint32_t more = 0; more < 3; more++) {
        assert_size(79 + more, 60);
        assert_size(80, 59 + more);
        assert_size(159 + more, 119 + more);
    }
}

static void test_a_frame_smaller_than_the_image_is_repeated(void)
{
    assert_size(7, 5);
    assert_size(40, 30);
    assert_size(79, 59);
}

static void test_one_axis_may_be_smaller_and_the_other_larger(void)
{
    assert_size(3, 200);
    assert_size(200, 3);
}

static void test_all_kinds_of_sizes_are_shared_out(void)
{
    for (uint32_t height = 1; height < 190; height += 21)
        for (uint32_t width = 1; width < 250; width += 13)
            assert_size(width, height);
}

static void test_the_widest_frame_is_shared_out(void)
{
    assert_size(5120, 1);
    assert_size(5119, 2);
}

static void test_the_tallest_frame_is_shared_out(void)
{
    assert_size(1, 3840);
    assert_size(2, 3839);
}

/* Moves a frame up by two bytes of its buffer, made one pixel too long. */
static void assert_size_at_half_a_word(uint32_t width, uint32_t height)
{
    const canvas_t aligned = canvas_noise(FRAME_RGB565, width, height);
    canvas_t shifted = canvas_new(FRAME_RGB565, width * height + 1, 1);
    shifted.frame = aligned.frame;
    shifted.bytes += 2;
    shifted.frame.bytes = shifted.bytes;
    memcpy(shifted.bytes, aligned.bytes, aligned.frame.length);
    assert_cells(&shifted);
    canvas_free_all();
}

static void test_rgb565_may_lie_at_half_a_word(void)
{
    assert_size_at_half_a_word(160, 120);
    assert_size_at_half_a_word(320, 240);
    assert_size_at_half_a_word(163, 127);
}

static void test_one_pixel_fills_the_image(void)
{
    const canvas_t canvas = canvas_of(FRAME_RGB888, 1, 1, (colour_t){9, 80, 7});
    image_fill(&expected, pixel_pack(9, 80, 7));

    whole_image_working(&image, &canvas.frame);

    assert_same_image(&expected, &image);
}

static void test_two_columns_share_the_image(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB888, 2, 1);
    canvas_set(&canvas, 1, 0, (colour_t){1, 2, 3});

    whole_image_working(&image, &canvas.frame);

    TEST_ASSERT_EQUAL_HEX32(0, image.pixel[39]);
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(1, 2, 3), image.pixel[40]);
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(1, 2, 3), image.pixel[79]);
    TEST_ASSERT_EQUAL_HEX32(0, image.pixel[80]);
}

static void test_rows_go_from_the_top(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB888, 160, 120);
    for (uint32_t x = 0; x < 160; x++)
        canvas_set(&canvas, x, 0, (colour_t){200, 0, 0});

    whole_image_working(&image, &canvas.frame);

    TEST_ASSERT_EQUAL_HEX32(pixel_pack(100, 0, 0), image.pixel[0]);
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(100, 0, 0), image.pixel[79]);
    TEST_ASSERT_EQUAL_HEX32(0, image.pixel[80]);
}

static void run_tests(void)
{
    RUN_TEST(test_rgb888_of_the_working_size_is_copied);
    RUN_TEST(test_qqvga_is_averaged_by_2_x_2);
    RUN_TEST(test_qvga_is_averaged_by_4_x_4);
    RUN_TEST(test_vga_is_averaged_by_8_x_8);
    RUN_TEST(test_svga_is_averaged_by_10_x_10);
    RUN_TEST(test_720p_is_averaged_by_16_x_12);
    RUN_TEST(test_uxga_is_averaged_by_20_x_20);
    RUN_TEST(test_a_size_that_is_no_multiple_is_shared_out);
    RUN_TEST(test_a_size_one_off_a_multiple_is_shared_out);
    RUN_TEST(test_a_frame_smaller_than_the_image_is_repeated);
    RUN_TEST(test_one_axis_may_be_smaller_and_the_other_larger);
    RUN_TEST(test_all_kinds_of_sizes_are_shared_out);
    RUN_TEST(test_the_widest_frame_is_shared_out);
    RUN_TEST(test_the_tallest_frame_is_shared_out);
    RUN_TEST(test_rgb565_may_lie_at_half_a_word);
    RUN_TEST(test_one_pixel_fills_the_image);
    RUN_TEST(test_two_columns_share_the_image);
    RUN_TEST(test_rows_go_from_the_top);
}

SUITE(run_tests)
