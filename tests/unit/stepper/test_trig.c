// Sine, cosine and angles of our own beside those of the C library.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unity.h>

#include "stepper/trig.h"

#define TURN (2 * M_PI)

void setUp(void) {}
void tearDown(void) {}

static double worst_error(uint32_t angle) {
    trig_t trig = trig_sin_cos(angle);
    double radians = angle * (TURN / TRIG_TURN);
    double cos_error = fabs(trig.cos / (double)TRIG_ONE - cos(radians));
    return fmax(cos_error, fabs(trig.sin / (double)TRIG_ONE - sin(radians)));
}

static void test_sine_and_cosine(void) {
    double worst = 0;
    srand(1);
    for (uint32_t i = 0; i < 2000000; i++) {
        worst = fmax(worst, worst_error(i * 2147u + (uint32_t)rand() % 2147u));
    }
    for (uint32_t place = 0; place < 256; place++) { // both sides of each change of table place
        uint32_t edge = (place << 24) + (1u << 23);
        for (uint32_t offset = 0; offset < 64; offset++) {
            worst = fmax(worst, worst_error(edge - 32 + offset));
            worst = fmax(worst, worst_error((place << 24) - 32 + offset));
        }
    }
    printf("sine and cosine: error at most 2^%.2f\n", log2(worst));
    TEST_ASSERT_TRUE(worst < ldexp(1, -29) * 0.66);
}

static void test_quarters_are_exact(void) {
    for (uint32_t quarter = 0; quarter < 4; quarter++) {
        trig_t trig = trig_sin_cos(quarter << 30);
        TEST_ASSERT_EQUAL_INT32((quarter % 2 == 0) * (1 - (int)quarter) * TRIG_ONE, trig.cos);
        TEST_ASSERT_EQUAL_INT32((quarter % 2 == 1) * (2 - (int)quarter) * TRIG_ONE, trig.sin);
    }
}

static void test_angles(void) {
    double worst = 0;
    for (int i = -400000; i <= 400000; i++) {
        double angle = i / 800001.0;
        double length = ldexp(1.0 + abs(i) % 1000 * 0.001, i % 30);
        double found = trig_angle(length * cos(angle * TURN), length * sin(angle * TURN));
        worst = fmax(worst, fabs(found - angle));
    }
    printf("angles: error at most %.2e turns\n", worst);
    TEST_ASSERT_TRUE(worst < 4e-10);
}

static void test_special_angles(void) {
    TEST_ASSERT_EQUAL_DOUBLE(0, trig_angle(3, 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.25, trig_angle(0, 3));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.5, fabs(trig_angle(-3, 0)));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -0.25, trig_angle(0, -3));
    TEST_ASSERT_DOUBLE_WITHIN(3e-10, 0.125, trig_angle(3, 3));
    for (double small = 1e-12; small < 0.1; small *= 3) {
        double relative = trig_angle(2 * cos(small), 2 * sin(small)) * TURN / small - 1;
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, relative);
        relative = trig_angle(2 * cos(small), -2 * sin(small)) * TURN / small + 1;
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, relative);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_sine_and_cosine);
    RUN_TEST(test_quarters_are_exact);
    RUN_TEST(test_angles);
    RUN_TEST(test_special_angles);
    return UNITY_END();
}
