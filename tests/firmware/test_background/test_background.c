/* The water's colour: the fullest grey bin and the mean of its pixels. */
#include "background_fixture.h"
#include "suite.h"

static uint32_t bin_of(uint32_t pixel)
{
    decide_on(WORKING_PIXELS, pixel, 0);
    return background.bin;
}

static void test_the_fullest_bin_is_the_water(void)
{
    decide_on(2401, GREY(220), GREY(20));
    TEST_ASSERT_EQUAL_UINT8(4, background.bin);

    decide_on(2399, GREY(220), GREY(20));
    TEST_ASSERT_EQUAL_UINT8(0, background.bin);
}

static void test_a_tie_between_bins_goes_to_the_darker(void)
{
    decide_on(2400, GREY(220), GREY(120));
    TEST_ASSERT_EQUAL_UINT8(2, background.bin);

    decide_on(2400, GREY(120), GREY(220));
    TEST_ASSERT_EQUAL_UINT8(2, background.bin);
}

static void test_the_pixels_of_every_bin_are_counted(void)
{
    static const uint16_t counts[5] = {900, 1000, 0, 2000, 900};
    image_fill(&image, GREY(30));
    image_fill_part(&image, 900, 1000, GREY(80));
    image_fill_part(&image, 1900, 2000, GREY(180));
    image_fill_part(&image, 3900, 900, GREY(230));

    decide();

    TEST_ASSERT_EQUAL_UINT16_ARRAY(counts, background.bin_counts, 5);
}

static void test_bins_are_fifths_of_the_grey_scale(void)
{
    static const uint32_t first[5] = {0, 52, 103, 154,
                                      205}; /* 256 / 5 = 51.2 */
    for (uint32_t bin = 0; bin < 5; bin++) {
        TEST_ASSERT_EQUAL_UINT32(bin, bin_of(GREY(first[bin])));
        if (bin > 0)
            TEST_ASSERT_EQUAL_UINT32(bin - 1, bin_of(GREY(first[bin] - 1)));
    }
    TEST_ASSERT_EQUAL_UINT32(4, bin_of(GREY(255)));
}

static void test_grey_weighs_the_channels_as_the_eye_does(void)
{
    /* 0.299 R + 0.587 G + 0.114 B, rounded: 51 is in bin 0, 52 in bin 1 */
    TEST_ASSERT_EQUAL_UINT32(0, bin_of(pixel_pack(172, 0, 0)));  /* 51.43 */
    TEST_ASSERT_EQUAL_UINT32(1, bin_of(pixel_pack(173, 0, 0)));  /* 51.73 */
    TEST_ASSERT_EQUAL_UINT32(0, bin_of(pixel_pack(0, 87, 0)));   /* 51.07 */
    TEST_ASSERT_EQUAL_UINT32(1, bin_of(pixel_pack(0, 88, 0)));   /* 51.66 */
    TEST_ASSERT_EQUAL_UINT32(0, bin_of(pixel_pack(0, 50, 194))); /* 51.46 */
    TEST_ASSERT_EQUAL_UINT32(1, bin_of(pixel_pack(0, 50, 195))); /* 51.58 */
}

static void test_value_is_the_mean_and_halves_go_up(void)
{
    decide_on(2400, GREY(110), GREY(111));
    TEST_ASSERT_EQUAL_UINT32(2400 * 221, background.value_sum);
    TEST_ASSERT_EQUAL_UINT8(111, background.value); /* 110.5 */

    decide_on(2401, GREY(110), GREY(111));
    TEST_ASSERT_EQUAL_UINT8(110, background.value);
}

static void test_saturation_is_the_mean_and_halves_go_up(void)
{
    const uint32_t s127 = pixel_pack(255, 128, 128);
    const uint32_t s128 = pixel_pack(255, 127, 127);

    decide_on(2400, s127, s128);
    TEST_ASSERT_EQUAL_UINT32(2400 * 255, background.saturation_sum);
    TEST_ASSERT_EQUAL_UINT8(128, background.saturation); /* 127.5 */

    decide_on(2401, s127, s128);
    TEST_ASSERT_EQUAL_UINT8(127, background.saturation);
}

static void test_only_the_pixels_of_the_bin_count(void)
{
    decide_on(3000, pixel_pack(0, 100, 100), pixel_pack(255, 200, 200));

    TEST_ASSERT_EQUAL_UINT16(768, background.hue);
    TEST_ASSERT_EQUAL_UINT8(255, background.saturation);
    TEST_ASSERT_EQUAL_UINT8(100, background.value);
    TEST_ASSERT_EQUAL_UINT32(3000 * 100, background.chroma_sum);
}

static void test_hues_are_weighted_by_chroma(void)
{
    /* red of chroma 150 and green of chroma 50, three to one: 19.1 degrees */
    decide_on(2400, pixel_pack(200, 50, 50), pixel_pack(60, 110, 60));

    TEST_ASSERT_EQUAL_INT32(2400 * (150 * 1024 - 50 * 512),
                            background.hue_sum.x);
    TEST_ASSERT_EQUAL_INT32(2400 * 50 * 887, background.hue_sum.y);
    TEST_ASSERT_EQUAL_UINT32(2400 * 200, background.chroma_sum);
    TEST_ASSERT_EQUAL_UINT16(82, background.hue); /* 81.6 */
}

static void test_hues_about_red_do_not_average_to_cyan(void)
{
    decide_on(2400, pixel_pack(150, 40, 60), pixel_pack(150, 60, 40));

    TEST_ASSERT_EQUAL_UINT16(0, background.hue);
    TEST_ASSERT_TRUE(background.meaningful);
}

static void test_the_longest_sum_of_hues_fits(void)
{
    decide_on(WORKING_PIXELS, pixel_pack(255, 0, 0), 0);
    TEST_ASSERT_EQUAL_INT32(4800 * 255 * 1024, background.hue_sum.x);

    decide_on(WORKING_PIXELS, pixel_pack(0, 255, 255), 0);
    TEST_ASSERT_EQUAL_INT32(-4800 * 255 * 1024, background.hue_sum.x);
    TEST_ASSERT_EQUAL_UINT8(255, background.resultant);
}

static void run_tests(void)
{
    RUN_TEST(test_the_fullest_bin_is_the_water);
    RUN_TEST(test_a_tie_between_bins_goes_to_the_darker);
    RUN_TEST(test_the_pixels_of_every_bin_are_counted);
    RUN_TEST(test_bins_are_fifths_of_the_grey_scale);
    RUN_TEST(test_grey_weighs_the_channels_as_the_eye_does);
    RUN_TEST(test_value_is_the_mean_and_halves_go_up);
    RUN_TEST(test_saturation_is_the_mean_and_halves_go_up);
    RUN_TEST(test_only_the_pixels_of_the_bin_count);
    RUN_TEST(test_hues_are_weighted_by_chroma);
    RUN_TEST(test_hues_about_red_do_not_average_to_cyan);
    RUN_TEST(test_the_longest_sum_of_hues_fits);
}

SUITE(run_tests)
