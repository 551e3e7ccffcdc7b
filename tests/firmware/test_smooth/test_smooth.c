/* The 3 x 3 binomial blur. */
#include "fixture.h"
#include "suite.h"

static whole_image_t image, expected;

/* `image` in place. */
static void smooth(void)
{
    const canvas_t canvas = canvas_of_image(&image);
    whole_image_smoothed(&image, &canvas.frame);
    canvas_free_all();
}

static uint32_t *pixel_at(whole_image_t *of, uint32_t x, uint32_t y)
{
    return &of->pixel[80 * y + x];
}

/* Blurs one bright pixel, 16 in all channels, and expects it to spread with the
 * given weights over its 3 x 3 neighbours, 0 elsewhere. */
static void assert_spread(uint32_t x, uint32_t y, const uint32_t weights[9])
{
    image_fill(&image, 0);
    image_fill(&expected, 0);
    *pixel_at(&image, x, y) = pixel_pack(16, 16, 16);
    for (uint32_t i = 0; i < 9; i++) {
        const uint32_t w = weights[i];
        if (w > 0)
            *pixel_at(&expected, x + i % 3 - 1, y + i / 3 - 1) =
                pixel_pack(w, w, w);
    }

    smooth();

    assert_same_image(&expected, &image);
}

static void test_a_pixel_spreads_by_the_binomial_weights(void)
{
    assert_spread(40, 30, (uint32_t[]){1, 2, 1, 2, 4, 2, 1, 2, 1});
    assert_spread(1, 1, (uint32_t[]){1, 2, 1, 2, 4, 2, 1, 2, 1});
    assert_spread(78, 58, (uint32_t[]){1, 2, 1, 2, 4, 2, 1, 2, 1});
}

static void test_the_top_edge_is_repeated(void)
{
    assert_spread(40, 0, (uint32_t[]){0, 0, 0, 3, 6, 3, 1, 2, 1});
}

static void test_the_bottom_edge_is_repeated(void)
{
    assert_spread(40, 59, (uint32_t[]){1, 2, 1, 3, 6, 3, 0, 0, 0});
}

static void test_the_left_edge_is_repeated(void)
{
    assert_spread(0, 30, (uint32_t[]){0, 3, 1, 0, 6, 2, 0, 3, 1});
}

static void test_the_right_edge_is_repeated(void)
{
    assert_spread(79, 30, (uint32_t[]){1, 3, 0, 2, 6, 0, 1, 3, 0});
}

static void test_the_four_corners_are_repeated(void)
{
    assert_spread(0, 0, (uint32_t[]){0, 0, 0, 0, 9, 3, 0, 3, 1});
    assert_spread(79, 0, (uint32_t[]){0, 0, 0, 3, 9, 0, 1, 3, 0});
    assert_spread(0, 59, (uint32_t[]){0, 3, 1, 0, 9, 3, 0, 0, 0});
    assert_spread(79, 59, (uint32_t[]){1, 3, 0, 3, 9, 0, 0, 0, 0});
}

static void test_one_colour_stays_as_it_is(void)
{
    for (uint32_t value = 0; value < 256; value++) {
        const uint32_t pixel = pixel_pack(value, 255 - value, value / 2);
        image_fill(&image, pixel);
        image_fill(&expected, pixel);

        smooth();

        assert_same_image(&expected, &image);
    }
}

static void test_halves_go_up(void)
{
    image_fill(&image, 0);
    *pixel_at(&image, 10, 10) =
        pixel_pack(2, 4, 8); /* in sixteenths: 8, 16, 32 */

    smooth();

    TEST_ASSERT_EQUAL_HEX32(pixel_pack(1, 1, 2), *pixel_at(&image, 10, 10));
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(0, 1, 1), *pixel_at(&image, 11, 10));
    TEST_ASSERT_EQUAL_HEX32(pixel_pack(0, 0, 1), *pixel_at(&image, 11, 11));
}

static void test_less_than_a_half_goes_down(void)
{
    image_fill(&image, 0);
    *pixel_at(&image, 10, 10) = pixel_pack(1, 1, 1); /* 4 sixteenths */
    *pixel_at(&image, 11, 11) =
        pixel_pack(3, 3, 3); /* 3 more there; 7 in all */

    smooth();

    TEST_ASSERT_EQUAL_HEX32(0, *pixel_at(&image, 10, 10));
}

static void test_channels_do_not_mix(void)
{
    static const uint32_t pure[3] = {255u << 20, 255u << 10, 255u};
    for (int i = 0; i < 3; i++) {
        image_fill(&image, 0);
        image_fill_part(&image, 2000, 500, pure[i]);

        smooth();

        for (uint32_t at = 0; at < WORKING_PIXELS; at++)
            TEST_ASSERT_EQUAL_HEX32(0, image.pixel[at] & ~pure[i]);
        TEST_ASSERT_EQUAL_HEX32(pure[i], image.pixel[2200]);
    }
}

/* One channel of the blur at a place, the nine weights spelled out. */
static uint32_t blurred(const whole_image_t *of, int x, int y, uint32_t shift)
{
    static const uint32_t weight[3] = {1, 2, 1};
    uint32_t sum = 0;
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            const int column = x + dx < 0 ? 0 : x + dx > 79 ? 79 : x + dx;
            const int row = y + dy < 0 ? 0 : y + dy > 59 ? 59 : y + dy;
            const uint32_t value = of->pixel[80 * row + column] >> shift & 255;
            sum += weight[dx + 1] * weight[dy + 1] * value;
        }
    }
    return (sum + 8) / 16;
}

static void test_noise_is_blurred_as_by_plain_sums(void)
{
    static whole_image_t before;
    uint32_t state = 1;
    for (uint32_t i = 0; i < WORKING_PIXELS; i++)
        before.pixel[i] = pixel_pack(noise(&state) & 255, noise(&state) & 255,
                                     noise(&state) & 255);
    for (int i = 0; i < (int)WORKING_PIXELS; i++)
        expected.pixel[i] = pixel_pack(blurred(&before, i % 80, i / 80, 20),
                                       blurred(&before, i % 80, i / 80, 10),
                                       blurred(&before, i % 80, i / 80, 0));
    image = before;

    smooth();

    assert_same_image(&expected, &image);
}

static void run_tests(void)
{
    RUN_TEST(test_a_pixel_spreads_by_the_binomial_weights);
    RUN_TEST(test_the_top_edge_is_repeated);
    RUN_TEST(test_the_bottom_edge_is_repeated);
    RUN_TEST(test_the_left_edge_is_repeated);
    RUN_TEST(test_the_right_edge_is_repeated);
    RUN_TEST(test_the_four_corners_are_repeated);
    RUN_TEST(test_one_colour_stays_as_it_is);
    RUN_TEST(test_halves_go_up);
    RUN_TEST(test_less_than_a_half_goes_down);
    RUN_TEST(test_channels_do_not_mix);
    RUN_TEST(test_noise_is_blurred_as_by_plain_sums);
}

SUITE(run_tests)
