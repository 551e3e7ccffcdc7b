/* How far the water's colour can be trusted, and when its hue means nothing. */
#include "background_fixture.h"
#include "suite.h"

static void test_one_colour_everywhere_is_certain(void)
{
    decide_on(WORKING_PIXELS, pixel_pack(0, 90, 180), 0);

    TEST_ASSERT_EQUAL_UINT16(896, background.hue); /* 210 degrees */
    TEST_ASSERT_EQUAL_UINT8(255, background.resultant);
    TEST_ASSERT_EQUAL_UINT8(255, background.share);
    TEST_ASSERT_EQUAL_UINT8(255, background.confidence);
    TEST_ASSERT_TRUE(background.meaningful);
}

static void test_hues_120_degrees_apart_halve_the_resultant(void)
{
    decide_on(2400, pixel_pack(150, 50, 50), pixel_pack(20, 120, 20));

    TEST_ASSERT_EQUAL_UINT16(256, background.hue);
    TEST_ASSERT_EQUAL_UINT8(128, background.resultant); /* 127.5 */
}

static void test_the_share_is_that_of_the_fullest_bin(void)
{
    decide_on(2880, pixel_pack(0, 90, 180), GREY(250));

    TEST_ASSERT_EQUAL_UINT8(153, background.share); /* 0.6 * 255 */
    TEST_ASSERT_EQUAL_UINT8(153, background.confidence);

    decide_on(4700, pixel_pack(0, 90, 180), GREY(250));
    TEST_ASSERT_EQUAL_UINT8(250, background.share); /* 249.7 */
}

static void test_the_confidence_is_resultant_times_share(void)
{
    decide_on(1440, pixel_pack(150, 50, 50), pixel_pack(20, 120, 20));
    image_fill_part(&image, 2880, 1920, GREY(250));

    decide();

    TEST_ASSERT_EQUAL_UINT8(128, background.resultant);
    TEST_ASSERT_EQUAL_UINT8(153, background.share);
    TEST_ASSERT_EQUAL_UINT8(77, background.confidence); /* 76.8 */
}

static void test_a_saturation_of_26_is_just_enough(void)
{
    decide_on(WORKING_PIXELS, pixel_pack(229, 229, 255), 0);
    TEST_ASSERT_EQUAL_UINT8(26, background.saturation);
    TEST_ASSERT_TRUE(background.meaningful);

    decide_on(WORKING_PIXELS, pixel_pack(230, 230, 255), 0);
    TEST_ASSERT_EQUAL_UINT8(25, background.saturation);
    TEST_ASSERT_FALSE(background.meaningful);
}

static void test_a_value_of_16_is_just_enough(void)
{
    decide_on(WORKING_PIXELS, pixel_pack(0, 0, 16), 0);
    TEST_ASSERT_TRUE(background.meaningful);

    decide_on(WORKING_PIXELS, pixel_pack(0, 0, 15), 0);
    TEST_ASSERT_FALSE(background.meaningful);
    TEST_ASSERT_EQUAL_UINT16(1024, background.hue);
}

static void test_a_resultant_of_64_is_just_enough(void)
{
    /* red against cyan: 255 * (2998 - 1802) / 4800 = 63.54 */
    decide_on(2998, pixel_pack(150, 50, 50), pixel_pack(20, 120, 120));
    TEST_ASSERT_EQUAL_UINT8(64, background.resultant);
    TEST_ASSERT_TRUE(background.meaningful);

    decide_on(2997, pixel_pack(150, 50, 50), pixel_pack(20, 120, 120));
    TEST_ASSERT_EQUAL_UINT8(63, background.resultant);
    TEST_ASSERT_FALSE(background.meaningful);
}

static void test_hues_that_cancel_out_leave_none(void)
{
    decide_on(2400, pixel_pack(150, 50, 50), pixel_pack(20, 120, 120));

    TEST_ASSERT_EQUAL_UINT16(0, background.hue);
    TEST_ASSERT_EQUAL_UINT8(0, background.resultant);
    TEST_ASSERT_EQUAL_UINT8(0, background.confidence);
    TEST_ASSERT_FALSE(background.meaningful);
}

static void test_greys_have_no_hue(void)
{
    for (uint32_t value = 0; value < 256; value += 51) {
        decide_on(WORKING_PIXELS, GREY(value), 0);

        TEST_ASSERT_EQUAL_UINT8(value, background.value);
        TEST_ASSERT_EQUAL_UINT8(0, background.saturation);
        TEST_ASSERT_EQUAL_UINT8(0, background.confidence);
        TEST_ASSERT_EQUAL_UINT8(255, background.share);
        TEST_ASSERT_FALSE(background.meaningful);
    }
}

static void run_tests(void)
{
    RUN_TEST(test_one_colour_everywhere_is_certain);
    RUN_TEST(test_hues_120_degrees_apart_halve_the_resultant);
    RUN_TEST(test_the_share_is_that_of_the_fullest_bin);
    RUN_TEST(test_the_confidence_is_resultant_times_share);
    RUN_TEST(test_a_saturation_of_26_is_just_enough);
    RUN_TEST(test_a_value_of_16_is_just_enough);
    RUN_TEST(test_a_resultant_of_64_is_just_enough);
    RUN_TEST(test_hues_that_cancel_out_leave_none);
    RUN_TEST(test_greys_have_no_hue);
}

SUITE(run_tests)
