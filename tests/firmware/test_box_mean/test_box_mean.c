/* The mean of a box: bytes in the camera's order, exact rounding. */
#include <string.h>

#include "fixture.h"
#include "suite.h"

static whole_image_t image, expected;

/* A frame to be filled box by box; `expected` is filled along with it. */
typedef struct {
    frame_format_t format;
    uint32_t width, height; /* of a box */
    canvas_t canvas;
} boxes_t;

static boxes_t boxes_new(frame_format_t format, uint32_t width, uint32_t height)
{
    return (boxes_t){format, width, height,
                     canvas_new(format, 80 * width, 60 * height)};
}

/* The i-th of `count` pixels that add up to `sum`. */
static uint32_t part(uint32_t sum, uint32_t count, uint32_t i)
{
    return sum / count + (i < sum % count);
}

static void boxes_set(const boxes_t *boxes, uint32_t at, colour_t sum)
{
    const uint32_t count = boxes->width * boxes->height;
    const uint32_t left = at % 80 * boxes->width, top = at / 80 * boxes->height;
    for (uint32_t i = 0; i < count; i++)
        canvas_set(
            &boxes->canvas, left + i % boxes->width, top + i / boxes->width,
            (colour_t){part(sum.red, count, i), part(sum.green, count, i),
                       part(sum.blue, count, i)});
    const uint32_t full = full_red(boxes->format);
    expected.pixel[at] = pixel_pack(
        mean_by_division(sum.red, count, full),
        mean_by_division(sum.green, count, full_green(boxes->format)),
        mean_by_division(sum.blue, count, full));
}

static void assert_boxes(const boxes_t *boxes)
{
    whole_image_working(&image, &boxes->canvas.frame);
    assert_same_image(&expected, &image);
}

static uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Every sum that a box of this size can have, as many at a time as fit. */
static void assert_all_sums(frame_format_t format, uint32_t width,
                            uint32_t height)
{
    const boxes_t boxes = boxes_new(format, width, height);
    const uint32_t red = full_red(format) * width * height;
    const uint32_t green = full_green(format) * width * height;
    for (uint32_t base = 0; base <= green; base += WORKING_PIXELS) {
        for (uint32_t at = 0; at < WORKING_PIXELS; at++) {
            const uint32_t sum = lesser(base + at, red);
            boxes_set(&boxes, at,
                      (colour_t){sum, lesser(base + at, green), red - sum});
        }
        assert_boxes(&boxes);
    }
    canvas_free_all();
}

/* The greatest sum that rounds to `mean` or less, on the scale of `top`. */
static uint32_t last_below(uint32_t mean, uint32_t top)
{
    return ((2 * mean + 1) * top - 1) / 510;
}

/* The sums on both sides of every place where the rounding turns over. */
static void assert_turning_points(frame_format_t format, uint32_t width,
                                  uint32_t height)
{
    const boxes_t boxes = boxes_new(format, width, height);
    const uint32_t red = full_red(format) * width * height;
    const uint32_t green = full_green(format) * width * height;
    for (uint32_t at = 0; at < WORKING_PIXELS; at++) {
        const uint32_t mean = at / 2 % 255, above = at % 2;
        boxes_set(&boxes, at,
                  (colour_t){last_below(mean, red) + above,
                             last_below(mean, green) + above,
                             last_below(254 - mean, red) + above});
    }
    assert_boxes(&boxes);
}

/* The first cell of a 160 x 60 frame whose first two pixels are these. */
static uint32_t mean_of_two(frame_format_t format, colour_t a, colour_t b)
{
    const canvas_t canvas = canvas_new(format, 160, 60);
    canvas_set(&canvas, 0, 0, a);
    canvas_set(&canvas, 1, 0, b);
    whole_image_working(&image, &canvas.frame);
    return image.pixel[0];
}

/* A frame of one pixel from the two bytes that the camera sends. */
static uint32_t pixel_of_bytes(uint8_t first, uint8_t second)
{
    const canvas_t canvas = canvas_new(FRAME_RGB565, 1, 1);
    canvas.bytes[0] = first;
    canvas.bytes[1] = second;
    whole_image_working(&image, &canvas.frame);
    canvas_free_all();
    return image.pixel[0];
}

static void test_rgb888_halves_go_up(void)
{
    const uint32_t mean = mean_of_two(FRAME_RGB888, (colour_t){0, 254, 10},
                                      (colour_t){1, 255, 10});

    TEST_ASSERT_EQUAL_HEX32(pixel_pack(1, 255, 10), mean);
}

static void test_rgb565_halves_go_up(void)
{
    /* 15.5 of 31, 10.5 of 63 and 15.5 of 31 are 127.5, 42.5 and 127.5 of 255 */
    const uint32_t mean =
        mean_of_two(FRAME_RGB565, (colour_t){31, 21, 15}, (colour_t){0, 0, 16});

    TEST_ASSERT_EQUAL_HEX32(pixel_pack(128, 43, 128), mean);
}

static void test_rgb565_is_not_widened_before_the_mean(void)
{
    /* Widened first, these would be 33 / 2, 65 / 2 and 99 / 2: one more each.
     */
    const uint32_t mean =
        mean_of_two(FRAME_RGB565, (colour_t){0, 0, 0}, (colour_t){4, 16, 12});

    TEST_ASSERT_EQUAL_HEX32(pixel_pack(16, 32, 49), mean);
}

static void test_red_is_the_high_bits_of_the_first_byte(void)
{
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(255, 0, 0), pixel_of_bytes(0xF8, 0x00));
    for (uint32_t red = 0; red < 32; red++)
        TEST_ASSERT_EQUAL_HEX32(pixel_pack((510 * red + 31) / 62, 0, 0),
                                pixel_of_bytes((uint8_t)(red << 3), 0));
}

static void test_green_spans_both_bytes(void)
{
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(0, 255, 0), pixel_of_bytes(0x07, 0xE0));
    for (uint32_t green = 0; green < 64; green++)
        TEST_ASSERT_EQUAL_HEX32(
            pixel_pack(0, (510 * green + 63) / 126, 0),
            pixel_of_bytes((uint8_t)(green >> 3), (uint8_t)(green << 5)));
}

static void test_blue_is_the_low_bits_of_the_second_byte(void)
{
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(0, 0, 255), pixel_of_bytes(0x00, 0x1F));
    for (uint32_t blue = 0; blue < 32; blue++)
        TEST_ASSERT_EQUAL_HEX32(pixel_pack(0, 0, (510 * blue + 31) / 62),
                                pixel_of_bytes(0, (uint8_t)blue));
}

static void test_rgb888_bytes_are_red_green_blue(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB888, 1, 1);
    memcpy(canvas.bytes, (uint8_t[]){11, 22, 33}, 3);

    whole_image_working(&image, &canvas.frame);

    TEST_ASSERT_EQUAL_HEX32(pixel_pack(11, 22, 33), image.pixel[4799]);
}

static void test_every_sum_of_a_small_rgb888_box_is_exact(void)
{
    for (uint32_t height = 1; height <= 3; height++)
        for (uint32_t width = 1; width <= 6; width++)
            assert_all_sums(FRAME_RGB888, width, height);
}

static void test_every_sum_of_a_small_rgb565_box_is_exact(void)
{
    for (uint32_t height = 1; height <= 4; height++)
        for (uint32_t width = 1; width <= 8; width++)
            assert_all_sums(FRAME_RGB565, width, height);
}

static void test_every_sum_of_a_larger_box_is_exact(void)
{
    assert_all_sums(FRAME_RGB888, 11, 1);
    assert_all_sums(FRAME_RGB888, 12, 1);
    assert_all_sums(FRAME_RGB565, 15, 3);
    assert_all_sums(FRAME_RGB565, 23, 2);
    assert_all_sums(FRAME_RGB565, 31, 3);
    assert_all_sums(FRAME_RGB565, 19, 7); /* from here on a reciprocal of 24 */
    assert_all_sums(FRAME_RGB565, 11, 9); /* bits would not be exact */
}

static void test_turning_points_of_uxga_are_exact(void)
{
    assert_turning_points(FRAME_RGB565, 20, 20);
    assert_turning_points(FRAME_RGB888, 20, 20);
}

static void test_turning_points_of_the_widest_frame_are_exact(void)
{
    assert_turning_points(FRAME_RGB565, 64, 1);
    assert_turning_points(FRAME_RGB888, 64, 1);
}

static void test_turning_points_of_the_largest_frame_are_exact(void)
{
    assert_turning_points(FRAME_RGB565, 64, 64);
    canvas_free_all();
    assert_turning_points(FRAME_RGB888, 64, 64);
}

static void test_the_largest_white_frame_is_white(void)
{
    const canvas_t canvas = canvas_new(FRAME_RGB565, 5120, 3840);
    memset(canvas.bytes, 0xFF, canvas.frame.length);
    image_fill(&expected, pixel_pack(255, 255, 255));

    whole_image_working(&image, &canvas.frame);

    assert_same_image(&expected, &image);
}

static void run_tests(void)
{
    RUN_TEST(test_rgb888_halves_go_up);
    RUN_TEST(test_rgb565_halves_go_up);
    RUN_TEST(test_rgb565_is_not_widened_before_the_mean);
    RUN_TEST(test_red_is_the_high_bits_of_the_first_byte);
    RUN_TEST(test_green_spans_both_bytes);
    RUN_TEST(test_blue_is_the_low_bits_of_the_second_byte);
    RUN_TEST(test_rgb888_bytes_are_red_green_blue);
    RUN_TEST(test_every_sum_of_a_small_rgb888_box_is_exact);
    RUN_TEST(test_every_sum_of_a_small_rgb565_box_is_exact);
    RUN_TEST(test_every_sum_of_a_larger_box_is_exact);
    RUN_TEST(test_turning_points_of_uxga_are_exact);
    RUN_TEST(test_turning_points_of_the_widest_frame_are_exact);
    RUN_TEST(test_turning_points_of_the_largest_frame_are_exact);
    RUN_TEST(test_the_largest_white_frame_is_white);
}

SUITE(run_tests)
