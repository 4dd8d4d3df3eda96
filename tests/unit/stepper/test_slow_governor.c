// A motion that begins behind a standstill is shown to the tick only when there is enough of it:
// the governor may be held up before it can go on. Here it is, and the segments are looked at as
// well.
#include <unity.h>

#include "bench.h"
#include "host_tick.h"
#include "stepper/segment.h"

// The governor may take this many ticks in one go, see tests/preempt.
#define BUSY_TICKS 50u

// The linker puts these in the place of the functions they are named after.
void __wrap_segment_writer_publish(void);
void __real_segment_writer_publish(void);
void __wrap_hal_on_governor(void);
void __real_hal_on_governor(void);

static unsigned busy_ticks;     // that the governor will lose in this call
static unsigned shortest_ticks; // of a motion that the tick saw begin behind a standstill

// Ticks of motion behind the last standstill in the ring; UINT32_MAX if there is no such motion.
static unsigned ticks_behind_standstill(void) {
    unsigned ticks = 0;
    bool stood = false;
    for (uint32_t n = ring_used(&segments.ring); n > 0; n--) {
        const segment_t *segment = &segments.slots[(segments.ring.written - n) % SEGMENTS];
        if ((segment->flags & SEGMENT_MAY_END) != 0) {
            stood = true;
            ticks = 0;
        } else {
            ticks += segment->ticks;
        }
    }
    return stood && ticks > 0 ? ticks : UINT32_MAX;
}

void __wrap_hal_on_governor(void) {
    busy_ticks = BUSY_TICKS;
    __real_hal_on_governor();
}

void __wrap_segment_writer_publish(void) {
    __real_segment_writer_publish();
    unsigned ticks = ticks_behind_standstill();
    shortest_ticks = ticks < shortest_ticks ? ticks : shortest_ticks;
    if (host_tick_context() == HOST_TICK_GOVERNOR) {
        for (; busy_ticks > 0; busy_ticks--) {
            host_tick_interrupt();
        }
    }
}

void setUp(void) {
    shortest_ticks = UINT32_MAX;
    bench_start();
}

void tearDown(void) {
    stepper_status_t status;
    stepper_status(&status);
    TEST_ASSERT_EQUAL(0, status.underruns);
    TEST_ASSERT_GREATER_OR_EQUAL(BUSY_TICKS, shortest_ticks);
    TEST_ASSERT_NOT_EQUAL(UINT32_MAX, shortest_ticks);
    bench_check_positions();
    bench_end();
}

static void test_dwells_before_moves(void) {
    for (unsigned ticks = 1; ticks <= 220; ticks++) {
        TEST_ASSERT_EQUAL(ERR_OK, stepper_dwell(ticks / 100.0));
        bench_move(ticks % 2 * 3, 0, 0, ticks * 0.1, 6000);
        bench_finish(10);
    }
}

static void test_resume_while_braking(void) {
    for (unsigned braking_us = 46000; braking_us < 54000; braking_us += 10) {
        bench_move(20, 10, 0, 0, 1500);
        bench_wait_us(100000);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
        bench_wait_us(braking_us);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
        bench_move(0, 0, 0, 0, 0);
        bench_finish(10);
    }
}

// A jog of another axis begins when the first one stands; in its last 2 ms it would be refused.
static void test_jogs_of_another_axis(void) {
    for (unsigned later_us = 0; later_us < 30000; later_us += 110) {
        TEST_ASSERT_EQUAL(ERR_OK, stepper_jog(AXIS_X, 10, 1000));
        bench_wait_us(100000);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_jog(AXIS_Y, -2, 1000));
        bench_wait_us(later_us);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_jog(AXIS_X, -2, 1000));
        bench_finish(10);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_dwells_before_moves);
    RUN_TEST(test_resume_while_braking);
    RUN_TEST(test_jogs_of_another_axis);
    return UNITY_END();
}
