// Virtual time, the tick's times, and the rules by which the governor gets its turn.
#include <string.h>
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"

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
} run;

static void log_tick(void) {
    run.tick_ns[run.ticks++ % LOG_SIZE] = host_clock_now_ns() - run.start_ns;
    if (run.ticks == run.request_at_tick) {
        hal_governor_request();
        hal_governor_request();
        TEST_ASSERT_EQUAL_UINT(0, run.governors); // the tick is above the governor
    }
    if (run.ticks == run.last_tick) {
        hal_tick_stop();
    }
}

static void log_governor(void) {
    run.depth++;
    run.depth_max = run.depth > run.depth_max ? run.depth : run.depth_max;
    run.governor_ns[run.governors++ % LOG_SIZE] = host_clock_now_ns() - run.start_ns;
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
    RUN_TEST(test_a_statement_takes_two_ticks);
    return UNITY_END();
}
