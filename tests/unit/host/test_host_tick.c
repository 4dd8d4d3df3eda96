// Virtual time, the tick's times, and the rules by which the governor gets its turn.
#include <string.h>
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"
#include "host_tick.h"

#define LOG_SIZE 64

static struct {
    uint64_t start_ns;
    uint64_t tick_ns[LOG_SIZE]; // times since start
    unsigned ticks;
    uint64_t governor_ns[LOG_SIZE];
    unsigned governors;
    unsigned last_tick; // stops the tick in this one; 0: never
    unsigned request_at_tick;
    unsigned repeats; // the governor asks for itself this often
    unsigned depth, depth_max;
    bool interrupt_tick, interrupt_governor;
    host_tick_context_t seen; // by the last tick or governor
} run;

static void log_tick(void) {
    run.tick_ns[run.ticks++ % LOG_SIZE] = host_clock_now_ns() - run.start_ns;
    run.seen = host_tick_context();
    if (run.interrupt_tick) {
        host_tick_interrupt();
    }
    if (run.ticks == run.request_at_tick) {
        unsigned before = run.governors;
        hal_governor_request();
        hal_governor_request();
        TEST_ASSERT_EQUAL_UINT(before, run.governors); // the tick is above the governor
    }
    if (run.ticks == run.last_tick) {
        hal_tick_stop();
    }
}

static void log_governor(void) {
    run.depth++;
    run.depth_max = run.depth > run.depth_max ? run.depth : run.depth_max;
    run.governor_ns[run.governors++ % LOG_SIZE] = host_clock_now_ns() - run.start_ns;
    if (run.interrupt_governor) {
        unsigned before = run.ticks;
        host_tick_interrupt();
        TEST_ASSERT_EQUAL_UINT(before + 1, run.ticks);
        TEST_ASSERT_EQUAL(HOST_TICK_TICK, run.seen);
    }
    run.seen = host_tick_context();
    if (run.repeats > 0) {
        run.repeats--;
        hal_governor_request();
    }
    run.depth--;
}

void setUp(void) {
    fixture_reset();
    fixture_core = (fixture_core_t){log_tick, log_governor};
    memset(&run, 0, sizeof run);
    run.start_ns = host_clock_now_ns();
}
void tearDown(void) {}

static void test_nth_tick_comes_n_periods_after_the_start(void) {
    host_clock_run(run.start_ns + 3700, false); // the grid hangs at the start, not at zero
    run.start_ns += 3700;
    hal_tick_start();
    hal_tick_start(); // no effect while it runs
    host_clock_run(run.start_ns + 40000, false);
    TEST_ASSERT_EQUAL_UINT(4, run.ticks);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT64((i + 1) * 10000u, run.tick_ns[i]);
    }
}

static void test_time_ends_where_it_was_asked_to(void) {
    hal_tick_start();
    TEST_ASSERT_FALSE(host_clock_run(run.start_ns + 15000, true));
    TEST_ASSERT_EQUAL_UINT64(run.start_ns + 15000, host_clock_now_ns());
    TEST_ASSERT_EQUAL_UINT64(run.start_ns + 20000, host_clock_next_event_ns());
    host_clock_run(run.start_ns, false); // not backwards
    TEST_ASSERT_EQUAL_UINT64(run.start_ns + 15000, host_clock_now_ns());
}

static void test_tick_that_stops_itself_is_the_last_one(void) {
    run.last_tick = 3;
    hal_tick_start();
    TEST_ASSERT_TRUE(host_clock_run(run.start_ns + 1000000, true));
    TEST_ASSERT_EQUAL_UINT(3, run.ticks);
    TEST_ASSERT_FALSE(hal_tick_running());
    TEST_ASSERT_EQUAL_UINT64(run.start_ns + 30000, host_clock_now_ns());
    TEST_ASSERT_EQUAL_UINT64(HOST_CLOCK_NEVER, host_clock_next_event_ns());
}

static void test_request_in_main_is_served_before_it_returns(void) {
    hal_governor_request();
    TEST_ASSERT_EQUAL_UINT(1, run.governors);
}

static void test_request_in_a_tick_is_served_right_after_it(void) {
    run.request_at_tick = 2;
    hal_tick_start();
    TEST_ASSERT_TRUE(host_clock_run(run.start_ns + 100000, true)); // and is news for main
    TEST_ASSERT_EQUAL_UINT(2, run.ticks);
    TEST_ASSERT_EQUAL_UINT(1, run.governors); // two requests before it came are one
    TEST_ASSERT_EQUAL_UINT64(20000, run.governor_ns[0]);
    host_clock_run(run.start_ns + 100000, false);
    TEST_ASSERT_EQUAL_UINT(10, run.ticks);
}

static void test_request_in_the_governor_brings_it_again_not_deeper(void) {
    run.repeats = 3;
    hal_governor_request();
    TEST_ASSERT_EQUAL_UINT(4, run.governors);
    TEST_ASSERT_EQUAL_UINT(1, run.depth_max);
}

static void test_lock_holds_the_governor_off(void) {
    hal_governor_lock();
    hal_governor_request();
    hal_governor_request();
    TEST_ASSERT_EQUAL_UINT(0, run.governors);
    hal_governor_unlock();
    TEST_ASSERT_EQUAL_UINT(1, run.governors);
    hal_governor_lock();
    hal_governor_unlock();
    TEST_ASSERT_EQUAL_UINT(1, run.governors);
}

static void test_lock_holds_off_what_a_tick_asks_for(void) {
    run.request_at_tick = 1;
    hal_tick_start();
    hal_governor_lock();
    host_clock_run(run.start_ns + 50000, false);
    TEST_ASSERT_EQUAL_UINT(5, run.ticks);
    TEST_ASSERT_EQUAL_UINT(0, run.governors);
    hal_governor_unlock();
    TEST_ASSERT_EQUAL_UINT64(50000, run.governor_ns[0]);
}

static void test_an_interrupted_main_loop_sees_the_tick_and_then_the_governor(void) {
    run.request_at_tick = 2;
    host_tick_interrupt(); // the tick is stopped
    TEST_ASSERT_EQUAL_UINT(0, run.ticks);
    hal_tick_start();
    host_tick_interrupt();
    TEST_ASSERT_EQUAL(HOST_TICK_TICK, run.seen);
    TEST_ASSERT_EQUAL_UINT64(run.start_ns + 10000, host_clock_now_ns());
    host_tick_interrupt();
    TEST_ASSERT_EQUAL(HOST_TICK_GOVERNOR, run.seen);
    TEST_ASSERT_EQUAL_UINT(1, run.governors);
    TEST_ASSERT_EQUAL(HOST_TICK_MAIN, host_tick_context());
    host_clock_run(run.start_ns + 50000, false); // the grid stays as it is
    TEST_ASSERT_EQUAL_UINT64(50000, run.tick_ns[4]);
}

static void test_an_interrupted_section_holds_the_governor_off(void) {
    run.request_at_tick = 1;
    hal_tick_start();
    hal_governor_lock();
    TEST_ASSERT_EQUAL(HOST_TICK_LOCKED, host_tick_context());
    host_tick_interrupt();
    TEST_ASSERT_EQUAL_UINT(1, run.ticks);
    TEST_ASSERT_EQUAL_UINT(0, run.governors);
    hal_governor_unlock();
    TEST_ASSERT_EQUAL_UINT(1, run.governors);
}

static void test_the_governor_is_interrupted_by_the_tick_only(void) {
    run.interrupt_tick = true; // without effect
    run.interrupt_governor = true;
    run.request_at_tick = 1; // by the tick that comes into the governor: once more, not deeper
    hal_tick_start();
    hal_governor_request();
    TEST_ASSERT_EQUAL_UINT(2, run.ticks);
    TEST_ASSERT_EQUAL_UINT(2, run.governors);
    TEST_ASSERT_EQUAL_UINT(1, run.depth_max);
}

static void test_a_statement_takes_two_ticks(void) {
    hal_tick_start();
    hal_statement();
    hal_statement();
    TEST_ASSERT_EQUAL_UINT(4, run.ticks);
    TEST_ASSERT_EQUAL_UINT64(run.start_ns / 1000 + 40, hal_time_us());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_nth_tick_comes_n_periods_after_the_start);
    RUN_TEST(test_time_ends_where_it_was_asked_to);
    RUN_TEST(test_tick_that_stops_itself_is_the_last_one);
    RUN_TEST(test_request_in_main_is_served_before_it_returns);
    RUN_TEST(test_request_in_a_tick_is_served_right_after_it);
    RUN_TEST(test_request_in_the_governor_brings_it_again_not_deeper);
    RUN_TEST(test_lock_holds_the_governor_off);
    RUN_TEST(test_lock_holds_off_what_a_tick_asks_for);
    RUN_TEST(test_an_interrupted_main_loop_sees_the_tick_and_then_the_governor);
    RUN_TEST(test_an_interrupted_section_holds_the_governor_off);
    RUN_TEST(test_the_governor_is_interrupted_by_the_tick_only);
    RUN_TEST(test_a_statement_takes_two_ticks);
    return UNITY_END();
}
