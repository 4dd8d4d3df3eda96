// How soon hold, stop, override and resume show at the pins: from the call to the first step that
// is not where it would have been without. The motion is deterministic, so one run without is the
// measure for all.
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#include <unity.h>

#include "bench.h"
#include "host_clock.h"
#include "watch.h"

#define SCALE 400.0
#define PLAIN_STEPS_MAX 100000u
#define REACTION_TICKS_MAX 199u // below 2 ms

static struct {
    uint32_t count;
    watch_step_t steps[PLAIN_STEPS_MAX];
} plain;
static uint64_t start_ns;
static uint32_t *answer; // shared with the children: tick of the first different step

void setUp(void) {}
void tearDown(void) {}

// So hard that a change of speed is seen in the steps within a fraction of a millisecond.
static void start(bool scurve) {
    static const stepper_axis_t axis = {.steps_per_unit = SCALE,
                                        .max_velocity = 6000,
                                        .max_acceleration = 1000000,
                                        .home_backoff_mm = 3};
    const double no_limits[AXIS_COUNT] = {0};
    bench_start_with(&axis, STEPPER_BLOCKS_MAX, false);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(scurve));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_jerk(STEPPER_JERK_MAX, no_limits));
    stepper_hold(true);
    bench_move(5, 0, 0, 0, 4000);
    for (int i = 1; i <= 30; i++) { // segments of all lengths
        bench_move(5 + 0.137 * i, 0, 0, 0, 4000);
    }
    bench_move(20, 0, 0, 0, 4000);
    bench_wait_us(20000);
    watch_reset();
    start_ns = host_clock_now_ns();
    stepper_hold(false);
}

static uint32_t tick_now(void) {
    return (uint32_t)((host_clock_now_ns() - start_ns) / 10000u);
}

static uint32_t first_difference(void) {
    const watch_step_t *steps = watch_steps(AXIS_X);
    uint32_t count = (uint32_t)watch_pulses(AXIS_X);
    uint32_t i = 0;
    while (i < plain.count && i < count && steps[i].tick == plain.steps[i].tick) {
        i++;
    }
    uint32_t missed = i < plain.count ? plain.steps[i].tick : UINT32_MAX;
    uint32_t made = i < count ? steps[i].tick : UINT32_MAX;
    uint32_t first = made < missed ? made : missed;
    return first <= tick_now() ? first : UINT32_MAX; // what is still to come is no difference
}

static void call_hold(void) {
    stepper_hold(true);
}

static void call_stop(void) {
    stepper_stop();
}

static void call_slower(void) {
    stepper_override(40, 100);
}

static void call_faster(void) {
    stepper_override(145, 100);
}

static void call_nothing(void) {}

// Ticks from the call to the first difference at this moment; in a child, so that the run can go
// on.
static uint32_t reaction_ticks(void (*call)(void)) {
    uint32_t begin = tick_now();
    *answer = 0;
    pid_t child = fork();
    if (child == 0) {
        call();
        bench_wait_us(10000);
        *answer = first_difference();
        _exit(0);
    }
    int status = 1;
    TEST_ASSERT_TRUE(child > 0 && waitpid(child, &status, 0) == child && status == 0);
    return *answer == UINT32_MAX ? UINT32_MAX : *answer - begin;
}

static void run_plain(bool scurve) {
    start(scurve);
    bench_finish(2);
    plain.count = (uint32_t)watch_pulses(AXIS_X);
    TEST_ASSERT_TRUE(plain.count > 1000 && plain.count <= PLAIN_STEPS_MAX);
    memcpy(plain.steps, watch_steps(AXIS_X), plain.count * sizeof plain.steps[0]);
    bench_end();
}

// The slowest reaction over many moments of cruising, through blocks long and short.
static uint32_t slowest(void (*call)(void), bool scurve) {
    run_plain(scurve);
    start(scurve);
    uint32_t worst = 0;
    bench_wait_us(10005);
    for (unsigned us = 10005; us < 180000; us += 370) {
        uint32_t ticks = reaction_ticks(call);
        worst = ticks > worst ? ticks : worst;
        bench_wait_us(370);
    }
    bench_finish(2);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, first_difference()); // the run was the plain one
    bench_end();
    return worst;
}

static void check(void (*call)(void), const char *name) {
    uint32_t worst[2];
    for (int scurve = 0; scurve <= 1; scurve++) {
        worst[scurve] = slowest(call, scurve);
        printf("%s, %s: at most %.2f ms\n", name, scurve ? "S-curve" : "trapezoid",
               worst[scurve] * 0.01);
    }
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(REACTION_TICKS_MAX, worst[0]);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(REACTION_TICKS_MAX, worst[1]);
}

static void test_hold(void) {
    check(call_hold, "hold");
}

static void test_stop(void) {
    check(call_stop, "stop");
}

static void test_override(void) {
    check(call_slower, "override down");
    check(call_faster, "override up");
}

static void test_resume(void) {
    for (int scurve = 0; scurve <= 1; scurve++) {
        for (unsigned us = 0; us < 3000; us += 70) {
            start(scurve);
            bench_wait_us(50000);
            stepper_hold(true);
            bench_wait_us(30000 + us);
            uint64_t steps = watch_pulses(AXIS_X);
            stepper_hold(false);
            bench_wait_us(2000);
            TEST_ASSERT_GREATER_THAN_UINT64(steps, watch_pulses(AXIS_X));
            bench_finish(2);
            bench_end();
        }
    }
}

static void test_no_call_makes_no_difference(void) {
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, slowest(call_nothing, false));
}

int main(void) {
    stepper_axis_t axes[AXIS_COUNT];
    memcpy(axes, bench_axes, sizeof axes);
    watch_attach(axes);
    answer = mmap(NULL, sizeof *answer, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    UNITY_BEGIN();
    RUN_TEST(test_hold);
    RUN_TEST(test_stop);
    RUN_TEST(test_override);
    RUN_TEST(test_resume);
    RUN_TEST(test_no_call_makes_no_difference);
    return UNITY_END();
}
