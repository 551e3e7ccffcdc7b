/* From the water's hue to the marker's. */
#include "golden.h"
#include "suite.h"

/* Hues in degrees: 1536 steps are 360 degrees. */
static uint16_t steps(int degrees)
{
    return (uint16_t)(degrees * 1536 / 360);
}

static uint16_t marker(uint16_t hue, uint8_t mapping)
{
    const background_t water = {.hue = hue, .meaningful = true};
    return marker_hue(&water, mapping, 777);
}

static void test_ternary_turns_every_hue_by_a_third(void)
{
    for (int hue = 0; hue < 1536; hue++)
        TEST_ASSERT_EQUAL_UINT16((hue + 512) % 1536,
                                 marker((uint16_t)hue, METHOD_MAPPING_TERNARY));
}

static void test_complement_turns_every_hue_by_a_half(void)
{
    for (int hue = 0; hue < 1536; hue++)
        TEST_ASSERT_EQUAL_UINT16(
            (hue + 768) % 1536,
            marker((uint16_t)hue, METHOD_MAPPING_COMPLEMENT));
}

static void test_blue_water_gets_a_red_marker(void)
{
    TEST_ASSERT_EQUAL_UINT16(0, marker(steps(240), METHOD_MAPPING_TERNARY));
}

static void test_green_water_gets_a_blue_marker(void)
{
    TEST_ASSERT_EQUAL_UINT16(steps(240),
                             marker(steps(120), METHOD_MAPPING_TERNARY));
}

static void test_ternary_of_90_degrees_is_210(void)
{
    TEST_ASSERT_EQUAL_UINT16(steps(210),
                             marker(steps(90), METHOD_MAPPING_TERNARY));
}

static void test_complement_of_90_degrees_is_270(void)
{
    /* The paper's |H - 180| would leave it at 90: the water's own hue. */
    TEST_ASSERT_EQUAL_UINT16(steps(270),
                             marker(steps(90), METHOD_MAPPING_COMPLEMENT));
}

static void test_complement_of_270_degrees_is_90(void)
{
    TEST_ASSERT_EQUAL_UINT16(steps(90),
                             marker(steps(270), METHOD_MAPPING_COMPLEMENT));
}

static void test_every_mapping_is_golden_for_every_hue(void)
{
    for (uint8_t mapping = 0; mapping < METHOD_MAPPING_COUNT; mapping++)
        for (uint16_t hue = 0; hue < METHOD_HUE_RANGE; hue++)
            TEST_ASSERT_EQUAL_UINT16(golden_marker_hues[mapping][hue],
                                     marker(hue, mapping));
}

static void test_contrast_turns_half_as_far_as_the_water_at_most(void)
{
    for (int first = 0; first < 1536; first++)
        for (int turn = 1; turn <= 768; turn++) {
            const int from = marker((uint16_t)first, METHOD_MAPPING_CONTRAST);
            const int to = marker((uint16_t)((first + turn) % 1536),
                                  METHOD_MAPPING_CONTRAST);
            const int apart = (to - from + 1536 + 768) % 1536 - 768;
            TEST_ASSERT_INT_WITHIN((turn + 1) / 2, 0, apart);
        }
}

static void test_brown_water_gets_a_red_marker_by_contrast(void)
{
    const int marker_hue = marker(steps(35), METHOD_MAPPING_CONTRAST);
    const int off_red = (marker_hue + 768) % 1536 - 768;
    TEST_ASSERT_INT_WITHIN(steps(15), 0, off_red);
}

static void test_blue_water_gets_a_magenta_marker_by_contrast(void)
{
    TEST_ASSERT_INT_WITHIN(steps(10), steps(300),
                           marker(steps(212), METHOD_MAPPING_CONTRAST));
}

static void test_old_settings_keep_their_meaning(void)
{
    TEST_ASSERT_EQUAL_INT(0, METHOD_MAPPING_TERNARY);
    TEST_ASSERT_EQUAL_INT(1, METHOD_MAPPING_COMPLEMENT);
    TEST_ASSERT_EQUAL_INT(2, METHOD_MAPPING_CONTRAST);
}

static void test_water_without_a_hue_gets_the_fallback(void)
{
    const background_t water = {.hue = 100, .meaningful = false};
    for (uint8_t mapping = 0; mapping < METHOD_MAPPING_COUNT; mapping++)
        TEST_ASSERT_EQUAL_UINT16(777, marker_hue(&water, mapping, 777));
}

static void test_the_fallback_is_not_turned(void)
{
    const background_t night = {.hue = 0, .meaningful = false};

    TEST_ASSERT_EQUAL_UINT16(0, marker_hue(&night, METHOD_MAPPING_TERNARY, 0));
    TEST_ASSERT_EQUAL_UINT16(1535,
                             marker_hue(&night, METHOD_MAPPING_TERNARY, 1535));
}

static void run_tests(void)
{
    RUN_TEST(test_ternary_turns_every_hue_by_a_third);
    RUN_TEST(test_complement_turns_every_hue_by_a_half);
    RUN_TEST(test_blue_water_gets_a_red_marker);
    RUN_TEST(test_green_water_gets_a_blue_marker);
    RUN_TEST(test_ternary_of_90_degrees_is_210);
    RUN_TEST(test_complement_of_90_degrees_is_270);
    RUN_TEST(test_complement_of_270_degrees_is_90);
    RUN_TEST(test_every_mapping_is_golden_for_every_hue);
    RUN_TEST(test_contrast_turns_half_as_far_as_the_water_at_most);
    RUN_TEST(test_brown_water_gets_a_red_marker_by_contrast);
    RUN_TEST(test_blue_water_gets_a_magenta_marker_by_contrast);
    RUN_TEST(test_old_settings_keep_their_meaning);
    RUN_TEST(test_water_without_a_hue_gets_the_fallback);
    RUN_TEST(test_the_fallback_is_not_turned);
}

SUITE(run_tests)
