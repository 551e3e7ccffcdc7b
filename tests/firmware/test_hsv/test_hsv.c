/* RGB to HSV and back. */
#include "hsv.h"
#include "suite.h"

static int32_t largest(int32_t a, int32_t b, int32_t c)
{
    const int32_t ab = a > b ? a : b;
    return ab > c ? ab : c;
}

static int32_t smallest(int32_t a, int32_t b, int32_t c)
{
    return -largest(-a, -b, -c);
}

static int32_t apart(int32_t a, int32_t b)
{
    return a > b ? a - b : b - a;
}

static void assert_rgb(int red, int green, int blue, rgb_t colour)
{
    TEST_ASSERT_EQUAL_UINT8(red, colour.red);
    TEST_ASSERT_EQUAL_UINT8(green, colour.green);
    TEST_ASSERT_EQUAL_UINT8(blue, colour.blue);
}

static void assert_hsv(int hue, int saturation, int value, hsv_t colour)
{
    TEST_ASSERT_EQUAL_UINT16(hue, colour.hue);
    TEST_ASSERT_EQUAL_UINT8(saturation, colour.saturation);
    TEST_ASSERT_EQUAL_UINT8(value, colour.value);
}

/* The hue of a colour that has one, by one division, halves up. */
static int32_t hue_by_division(int32_t red, int32_t green, int32_t blue)
{
    const int32_t value = largest(red, green, blue);
    const int32_t chroma = value - smallest(red, green, blue);
    int32_t along = red - green + 4 * chroma;
    if (value == green)
        along = blue - red + 2 * chroma;
    if (value == red)
        along = green >= blue ? green - blue : green - blue + 6 * chroma;
    return (512 * along + chroma) / (2 * chroma) % 1536;
}

/* The pure colour number i of 1530, around the hexagon from red. */
static rgb_t pure(uint32_t i)
{
    const uint8_t up = (uint8_t)(i % 255), down = (uint8_t)(255 - up);
    const rgb_t sextants[6] = {{255, up, 0},   {down, 255, 0}, {0, 255, up},
                               {0, down, 255}, {up, 0, 255},   {255, 0, down}};
    return sextants[i / 255];
}

static void test_the_six_corners_are_256_apart(void)
{
    assert_hsv(0, 255, 255, hsv_from_rgb(255, 0, 0));
    assert_hsv(256, 255, 255, hsv_from_rgb(255, 255, 0));
    assert_hsv(512, 255, 255, hsv_from_rgb(0, 255, 0));
    assert_hsv(768, 255, 255, hsv_from_rgb(0, 255, 255));
    assert_hsv(1024, 255, 255, hsv_from_rgb(0, 0, 255));
    assert_hsv(1280, 255, 255, hsv_from_rgb(255, 0, 255));
}

static void test_the_hue_wraps_below_red(void)
{
    assert_hsv(1, 255, 255, hsv_from_rgb(255, 1, 0));
    assert_hsv(1535, 255, 255, hsv_from_rgb(255, 0, 1));
}

static void test_black_white_and_grey_have_hue_and_saturation_0(void)
{
    for (uint32_t grey = 0; grey < 256; grey++)
        assert_hsv(0, 0, (int)grey, hsv_from_rgb(grey, grey, grey));
}

static void test_the_hue_is_rounded(void)
{
    assert_hsv(1, 255, 200, hsv_from_rgb(200, 1, 0)); /* 1.28 */
    assert_hsv(3, 255, 200, hsv_from_rgb(200, 2, 0)); /* 2.56 */
    assert_hsv(1535, 255, 200, hsv_from_rgb(200, 0, 1));
    assert_hsv(1533, 255, 200, hsv_from_rgb(200, 0, 2));
}

static void test_a_half_of_saturation_goes_up(void)
{
    assert_hsv(0, 128, 2, hsv_from_rgb(2, 1, 1));   /* 127.5 */
    assert_hsv(0, 9, 30, hsv_from_rgb(30, 29, 29)); /* 8.5 */
}

static void test_every_pure_colour_comes_back(void)
{
    for (uint32_t i = 0; i < 1530; i++) {
        const rgb_t rgb = pure(i);
        const hsv_t hsv = hsv_from_rgb(rgb.red, rgb.green, rgb.blue);

        assert_rgb(rgb.red, rgb.green, rgb.blue,
                   rgb_from_hsv(hsv.hue, hsv.saturation, hsv.value));
        TEST_ASSERT_EQUAL_UINT32((512 * i + 255) / 510, hsv.hue);
    }
}

static void test_every_hue_comes_back_from_its_pure_colour(void)
{
    for (uint32_t hue = 0; hue < 1536; hue++) {
        const rgb_t rgb = rgb_from_hsv(hue, 255, 255);
        const hsv_t hsv = hsv_from_rgb(rgb.red, rgb.green, rgb.blue);

        /* 1530 colours have 1536 hues: the middle one of each sextant shares
         * the colour of a neighbour. */
        uint32_t back = hue;
        if (hue % 256 == 128)
            back = hue / 256 % 2 == 0 ? hue + 1 : hue - 1;
        assert_hsv((int)back, 255, 255, hsv);
    }
}

static void test_all_colours_have_a_hue_within_one_step(void)
{
    int32_t inexact = 0;
    for (int32_t rgb = 0; rgb < 1 << 24; rgb++) {
        const int32_t r = rgb >> 16, g = rgb >> 8 & 255, b = rgb & 255;
        if (r == g && g == b)
            continue;
        const hsv_t hsv = hsv_from_rgb((uint32_t)r, (uint32_t)g, (uint32_t)b);
        const int32_t off = apart(hue_by_division(r, g, b), hsv.hue);
        inexact += off != 0;
        if (hsv.hue >= 1536 || (off > 1 && off != 1535))
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(-1, rgb, "hue of this colour");
    }
    TEST_ASSERT_TRUE(inexact < 1 << 18); /* the 12-bit tables' share: 1.3 % */
}

static void test_all_colours_have_the_right_saturation_and_value(void)
{
    int32_t inexact = 0;
    for (int32_t rgb = 1; rgb < 1 << 24; rgb++) {
        const int32_t r = rgb >> 16, g = rgb >> 8 & 255, b = rgb & 255;
        const hsv_t hsv = hsv_from_rgb((uint32_t)r, (uint32_t)g, (uint32_t)b);
        const int32_t value = largest(r, g, b),
                      chroma = value - smallest(r, g, b);
        const int32_t saturation = (510 * chroma + value) / (2 * value);
        const int32_t off = apart(saturation, hsv.saturation);
        inexact += off != 0;
        if ((int32_t)hsv.value != value || (int32_t)hsv.chroma != chroma ||
            off > 1 || (hsv.saturation == 0) != (chroma == 0))
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(-1, rgb, "S, V of this colour");
    }
    TEST_ASSERT_TRUE(inexact < 1 << 18); /* 0.7 % */
}

static void test_all_colours_come_back_within_one(void)
{
    for (int32_t rgb = 0; rgb < 1 << 24; rgb++) {
        const int32_t r = rgb >> 16, g = rgb >> 8 & 255, b = rgb & 255;
        const hsv_t hsv = hsv_from_rgb((uint32_t)r, (uint32_t)g, (uint32_t)b);
        const rgb_t back = rgb_from_hsv(hsv.hue, hsv.saturation, hsv.value);
        if (largest(apart(r, back.red), apart(g, back.green),
                    apart(b, back.blue)) > 1)
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(-1, rgb, "this colour");
    }
}

static void test_without_saturation_every_hue_is_grey(void)
{
    for (uint32_t hue = 0; hue < 1536; hue++)
        assert_rgb(77, 77, 77, rgb_from_hsv(hue, 0, 77));
}

static void test_without_value_every_hue_is_black(void)
{
    for (uint32_t hue = 0; hue < 1536; hue++)
        assert_rgb(0, 0, 0, rgb_from_hsv(hue, 255, 0));
}

static void test_the_least_channel_is_rounded(void)
{
    assert_rgb(255, 155, 155, rgb_from_hsv(0, 100, 255));
    assert_rgb(100, 50, 50, rgb_from_hsv(0, 128, 100)); /* less 50.2 */
    assert_rgb(200, 99, 99, rgb_from_hsv(0, 129, 200)); /* less 101.2 */
    assert_rgb(99, 49, 49, rgb_from_hsv(0, 128, 99));   /* less 49.7 */
}

static void test_a_half_of_the_middle_channel_goes_up(void)
{
    assert_rgb(1, 1, 0, rgb_from_hsv(128, 255, 1));
    assert_rgb(1, 1, 0, rgb_from_hsv(256 + 128, 255, 1));
    assert_rgb(1, 0, 0, rgb_from_hsv(127, 255, 1));
    assert_rgb(0, 1, 0, rgb_from_hsv(256 + 129, 255, 1));
}

static void test_the_ranges_of_opencv_come_from_the_same_formula(void)
{
    static const uint8_t corner[6][3] = {{255, 0, 0}, {255, 255, 0},
                                         {0, 255, 0}, {0, 255, 255},
                                         {0, 0, 255}, {255, 0, 255}};
    static const uint16_t of_180[6] = {0, 30, 60, 90, 120, 150};
    static const uint16_t of_256[6] = {0, 43, 85, 128, 171, 213};
    for (int i = 0; i < 6; i++) {
        const uint8_t *c = corner[i];
        const hsv_t narrow = hsv_on_scale(c[0], c[1], c[2], HUE_SCALE_180);
        const hsv_t full = hsv_on_scale(c[0], c[1], c[2], HUE_SCALE_256);
        assert_hsv(of_180[i], 255, 255, narrow);
        assert_hsv(of_256[i], 255, 255, full);
    }
}

static void run_tests(void)
{
    RUN_TEST(test_the_six_corners_are_256_apart);
    RUN_TEST(test_the_hue_wraps_below_red);
    RUN_TEST(test_black_white_and_grey_have_hue_and_saturation_0);
    RUN_TEST(test_the_hue_is_rounded);
    RUN_TEST(test_a_half_of_saturation_goes_up);
    RUN_TEST(test_every_pure_colour_comes_back);
    RUN_TEST(test_every_hue_comes_back_from_its_pure_colour);
    RUN_TEST(test_all_colours_have_a_hue_within_one_step);
    RUN_TEST(test_all_colours_have_the_right_saturation_and_value);
    RUN_TEST(test_all_colours_come_back_within_one);
    RUN_TEST(test_without_saturation_every_hue_is_grey);
    RUN_TEST(test_without_value_every_hue_is_black);
    RUN_TEST(test_the_least_channel_is_rounded);
    RUN_TEST(test_a_half_of_the_middle_channel_goes_up);
    RUN_TEST(test_the_ranges_of_opencv_come_from_the_same_formula);
}

SUITE(run_tests)
