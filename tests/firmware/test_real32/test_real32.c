/* Single precision in integers, against this computer's own floats. */
#include "real32.h"

#include <string.h>

#include "fixture.h"
#include "suite.h"

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Converting rounds once, to even; a power of two divides without rounding. */
static float by_compiler(int64_t n, uint8_t shift)
{
    return (float)n / (float)(UINT64_C(1) << shift);
}

static void assert_from(int64_t n, uint8_t shift)
{
    TEST_ASSERT_EQUAL_HEX32(bits_of(by_compiler(n, shift)),
                            real32_from_fixed(n, shift));
    if (n > INT64_MIN)
        TEST_ASSERT_EQUAL_HEX32(bits_of(by_compiler(-n, shift)),
                                real32_from_fixed(-n, shift));
}

/* Doubles hold the product, and the sum with a half, exactly below 2^52. */
static void assert_to(float value, uint8_t shift)
{
    const double scaled = (double)value * (double)(UINT64_C(1) << shift);
    const int64_t expected = (int64_t)(scaled + (scaled < 0 ? -0.5 : 0.5));
    int64_t n = 77;
    TEST_ASSERT_TRUE(real32_to_fixed(bits_of(value), shift, &n));
    TEST_ASSERT_EQUAL_INT64(expected, n);
}

static uint64_t noise64(uint32_t *state)
{
    uint64_t n = 0;
    for (int i = 0; i < 4; i++)
        n = n << 16 | (noise(state) & 0xFFFF);
    return n;
}

static void test_small_whole_numbers_are_exact(void)
{
    for (int64_t n = 0; n < 5000; n++)
        assert_from(n, 0);
    TEST_ASSERT_EQUAL_HEX32(0x3F800000, real32_from_fixed(1, 0));
    TEST_ASSERT_EQUAL_HEX32(0xC0490000, real32_from_fixed(-201, 6));
    TEST_ASSERT_EQUAL_HEX32(0, real32_from_fixed(0, 63));
}

static void test_numbers_of_every_length_and_shift_are_the_compilers(void)
{
    uint32_t state = 1;
    for (uint8_t length = 1; length < 64; length++)
        for (uint8_t shift = 0; shift < 64; shift++)
            for (int i = 0; i < 5; i++)
                assert_from((int64_t)(noise64(&state) >> (64 - length)), shift);
}

static void test_ties_go_to_even(void)
{
    for (int64_t half = 1; half < INT64_C(1) << 30; half *= 2)
        for (int64_t m = (1 << 23); m < (1 << 23) + 6; m++)
            for (int64_t off = -1; off <= 1; off++)
                assert_from((2 * m + 1) * half + off, 3);
    TEST_ASSERT_EQUAL_HEX32(bits_of(16777216), real32_from_fixed(16777217, 0));
    TEST_ASSERT_EQUAL_HEX32(bits_of(16777220), real32_from_fixed(16777219, 0));
}

static void test_rounding_up_can_reach_the_next_power_of_two(void)
{
    for (uint8_t length = 24; length < 63; length++)
        for (int64_t below = 0; below < 4; below++)
            assert_from((INT64_C(1) << length) - below, 0);
    assert_from(INT64_MAX, 0);
    assert_from(INT64_MAX, 63);
    assert_from(INT64_MIN, 0);
    assert_from(INT64_MIN, 63);
}

static void test_floats_of_all_exponents_round_as_the_compiler_does(void)
{
    uint32_t state = 2;
    for (uint32_t exponent = 1; exponent < 127 + 51; exponent++)
        for (uint32_t i = 0; i < 40; i++) {
            const uint32_t fraction = (uint32_t)noise64(&state) & 0x7FFFFF;
            const uint32_t sign = (i & 1) << 31;
            const float value = of_bits(sign | exponent << 23 | fraction);
            assert_to(value, 0);
            if (exponent < 127 + 51 - 20)
                assert_to(value, 20);
        }
}

static void test_halves_round_away_from_zero(void)
{
    for (int n = -2000; n <= 2000; n++)
        assert_to((float)n + 0.5f, 0);
    int64_t n;
    TEST_ASSERT_TRUE(real32_to_fixed(bits_of(-2.5f), 0, &n));
    TEST_ASSERT_EQUAL_INT64(-3, n);
    TEST_ASSERT_TRUE(real32_to_fixed(bits_of(0.49999997f), 0, &n));
    TEST_ASSERT_EQUAL_INT64(0, n);
}

static void test_zeros_and_denormals_are_zero(void)
{
    static const uint32_t tiny[] = {
        0, 0x80000000, 1, 0x80000001, 0x007FFFFF, 0x807FFFFF, 0x00800000};
    for (size_t i = 0; i < sizeof tiny / sizeof tiny[0]; i++) {
        int64_t n = 77;
        TEST_ASSERT_TRUE(real32_to_fixed(tiny[i], 28, &n));
        TEST_ASSERT_EQUAL_INT64(0, n);
    }
}

static void assert_no_number(uint32_t bits, uint8_t shift)
{
    int64_t n = 77;
    TEST_ASSERT_FALSE(real32_to_fixed(bits, shift, &n));
    TEST_ASSERT_EQUAL_INT64(77, n);
    TEST_ASSERT_FALSE(real32_to_fixed(bits | 0x80000000, shift, &n));
}

static void test_nan_infinity_and_the_huge_are_no_numbers(void)
{
    for (uint8_t shift = 0; shift <= 20; shift++) {
        assert_no_number(0x7F800000, shift); /* infinity */
        assert_no_number(0x7F800001, shift); /* signalling NaN */
        assert_no_number(0x7FC00000, shift); /* quiet NaN */
        assert_no_number(0x7FFFFFFF, shift);
        assert_no_number(0x7F7FFFFF, shift); /* the largest number */
        /* 2^53 after the shift, with certainty beyond 2^52 */
        assert_no_number((uint32_t)(127 + 53 - shift) << 23, shift);
    }
}

static void test_there_and_back_is_the_same_number(void)
{
    for (int64_t n = -40000; n <= 40000; n += 7)
        for (uint8_t shift = 0; shift <= 20; shift += 4) {
            int64_t back;
            TEST_ASSERT_TRUE(
                real32_to_fixed(real32_from_fixed(n, shift), shift, &back));
            TEST_ASSERT_EQUAL_INT64(n, back);
        }
}

static void run_tests(void)
{
    RUN_TEST(test_small_whole_numbers_are_exact);
    RUN_TEST(test_numbers_of_every_length_and_shift_are_the_compilers);
    RUN_TEST(test_ties_go_to_even);
    RUN_TEST(test_rounding_up_can_reach_the_next_power_of_two);
    RUN_TEST(test_floats_of_all_exponents_round_as_the_compiler_does);
    RUN_TEST(test_halves_round_away_from_zero);
    RUN_TEST(test_zeros_and_denormals_are_zero);
    RUN_TEST(test_nan_infinity_and_the_huge_are_no_numbers);
    RUN_TEST(test_there_and_back_is_the_same_number);
}

SUITE(run_tests)
