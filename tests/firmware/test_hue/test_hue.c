/* Hues as unit vectors, and the hue of a sum of vectors. */
#include "hue.h"

#include "fixture.h"
#include "suite.h"

/* The true unit vectors, by turning one step at a time; no libm needed. */
static double true_cos[1536], true_sin[1536];

static void make_true_circle(void)
{
    const double c = 0.9999916334443506,
                 s = 0.004090604026234789; /* 2pi/1536 */
    true_cos[0] = 1;
    true_sin[0] = 0;
    for (int i = 1; i < 1536; i++) {
        true_cos[i] = c * true_cos[i - 1] - s * true_sin[i - 1];
        true_sin[i] = s * true_cos[i - 1] + c * true_sin[i - 1];
    }
}

static bool differs_by_at_most(double most, double a, double b)
{
    return a - b <= most && b - a <= most;
}

static void assert_hue(uint32_t expected, int32_t x, int32_t y)
{
    uint16_t hue = 9999;
    TEST_ASSERT_TRUE(hue_of_vector((hue_vector_t){x, y}, &hue));
    TEST_ASSERT_EQUAL_UINT16(expected, hue);
}

static void test_the_axes_are_exact(void)
{
    static const int32_t axis[4][2] = {
        {1024, 0}, {0, 1024}, {-1024, 0}, {0, -1024}};
    for (uint32_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT32(axis[i][0], hue_cos(384 * i));
        TEST_ASSERT_EQUAL_INT32(axis[i][1], hue_sin(384 * i));
    }
}

static void test_sine_and_cosine_are_rounded_to_the_nearest(void)
{
    make_true_circle();
    for (uint32_t hue = 0; hue < 1536; hue++) {
        TEST_ASSERT_TRUE(
            differs_by_at_most(0.5, hue_cos(hue), 1024 * true_cos[hue]));
        TEST_ASSERT_TRUE(
            differs_by_at_most(0.5, hue_sin(hue), 1024 * true_sin[hue]));
    }
}

static void test_every_unit_vector_has_its_hue(void)
{
    for (uint32_t hue = 0; hue < 1536; hue++)
        assert_hue(hue, hue_cos(hue), hue_sin(hue));
}

static void test_a_longer_vector_has_the_same_hue(void)
{
    for (int32_t length = 3; length < 1 << 21; length *= 4)
        for (uint32_t hue = 0; hue < 1536; hue++)
            assert_hue(hue, hue_cos(hue) * length, hue_sin(hue) * length);
}

static void test_vectors_along_the_axes_are_exact(void)
{
    static const int32_t lengths[] = {1, 2, 1023, 1 << 21, INT32_MAX};
    for (int i = 0; i < 5; i++) {
        assert_hue(0, lengths[i], 0);
        assert_hue(384, 0, lengths[i]);
        assert_hue(768, -lengths[i], 0);
        assert_hue(1152, 0, -lengths[i]);
    }
}

static void test_vectors_along_the_diagonals_are_exact(void)
{
    static const int32_t lengths[] = {1, 2, 1023, 1 << 21, INT32_MAX};
    for (int i = 0; i < 5; i++) {
        assert_hue(192, lengths[i], lengths[i]);
        assert_hue(576, -lengths[i], lengths[i]);
        assert_hue(960, -lengths[i], -lengths[i]);
        assert_hue(1344, lengths[i], -lengths[i]);
    }
}

static void test_the_least_integer_has_a_hue(void)
{
    assert_hue(768, INT32_MIN, 0);
    assert_hue(1152, 0, INT32_MIN);
    assert_hue(960, INT32_MIN, INT32_MIN);
    assert_hue(576, INT32_MIN, INT32_MAX);
    assert_hue(1344, INT32_MAX, INT32_MIN);
}

static void test_the_zero_vector_has_none(void)
{
    uint16_t hue = 77;

    TEST_ASSERT_FALSE(hue_of_vector((hue_vector_t){0, 0}, &hue));

    TEST_ASSERT_EQUAL_UINT16(77, hue);
}

static void test_a_little_below_red_is_0_or_1535(void)
{
    /* A step is 0.0041 rad: its half is passed at 1 in 489. */
    assert_hue(0, 1000000, -1);
    assert_hue(0, 1024, -2);
    assert_hue(1535, 1024, -3);
    assert_hue(1535, 1024, -4);
    assert_hue(0, INT32_MAX, -1000);
}

static void test_a_mirrored_vector_has_the_mirrored_hue(void)
{
    uint32_t state = 3;
    for (int i = 0; i < 2000; i++) {
        const int32_t x = 1 + (int32_t)noise(&state);
        const int32_t y = 1 + (int32_t)noise(&state);
        uint16_t hue = 9999;
        hue_of_vector((hue_vector_t){x, y}, &hue);

        TEST_ASSERT_TRUE(hue <= 384);
        assert_hue(768u - hue, -x, y);
        assert_hue(768u + hue, -x, -y);
        assert_hue((1536u - hue) % 1536, x, -y);
        if (x != y)
            assert_hue(384u - hue, y, x);
    }
}

static int32_t signed_noise(uint32_t *state)
{
    const int32_t high = (int32_t)noise(state) - 32768;
    const int32_t value = high * 65536 + (int32_t)noise(state);
    return value / (1 << noise(state) % 31);
}

static void test_any_vector_has_its_hue_within_a_step(void)
{
    make_true_circle();
    uint32_t state = 4;
    for (int i = 0; i < 200000; i++) {
        const hue_vector_t v = {signed_noise(&state), signed_noise(&state)};
        uint16_t hue = 0;
        if (!hue_of_vector(v, &hue))
            continue;
        const double along = true_cos[hue] * v.x + true_sin[hue] * v.y;
        const double across = true_cos[hue] * v.y - true_sin[hue] * v.x;
        /* The tangent of 0.65 steps: half for rounding, the rest the table's.
         */
        TEST_ASSERT_TRUE(along > 0);
        TEST_ASSERT_TRUE(differs_by_at_most(0.00266 * along, across, 0));
    }
}

static void run_tests(void)
{
    RUN_TEST(test_the_axes_are_exact);
    RUN_TEST(test_sine_and_cosine_are_rounded_to_the_nearest);
    RUN_TEST(test_every_unit_vector_has_its_hue);
    RUN_TEST(test_a_longer_vector_has_the_same_hue);
    RUN_TEST(test_vectors_along_the_axes_are_exact);
    RUN_TEST(test_vectors_along_the_diagonals_are_exact);
    RUN_TEST(test_the_least_integer_has_a_hue);
    RUN_TEST(test_the_zero_vector_has_none);
    RUN_TEST(test_a_little_below_red_is_0_or_1535);
    RUN_TEST(test_a_mirrored_vector_has_the_mirrored_hue);
    RUN_TEST(test_any_vector_has_its_hue_within_a_step);
}

SUITE(run_tests)
