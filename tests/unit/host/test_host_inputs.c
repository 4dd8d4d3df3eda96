// Input events: their order, their place among the ticks, and what is said about a bad file.
#include <string.h>
#include <unity.h>

#include "fixture.h"
#include "hal/hal.h"
#include "host_clock.h"
#include "host_inputs.h"

static uint32_t seen_at_tick[8]; // levels of the pins
static unsigned ticks;

static void look(void) {
    if (ticks < 8) {
        seen_at_tick[ticks++] = hal_pins_read();
    }
}

void setUp(void) {}
void tearDown(void) {}

// One run for all of it: a program reads its events once.
static void test_events_come_in_order_of_time_and_before_a_tick_of_the_same_time(void) {
    static const char events[] = "time_ns,gpio,level\n"
                                 "30000,5,1\r\n"
                                 "\n"
                                 "10000,5,1\n"
                                 "25000,5,0\n"
                                 "25000,6,1\n"
                                 "25000,6,0\n"
                                 "45000,6,1";
    host_inputs_load(fixture_file("events.csv", events, sizeof events - 1));
    TEST_ASSERT_EQUAL_UINT64(10000, host_inputs_next_ns());
    fixture_core.on_tick = look;
    hal_tick_start();
    TEST_ASSERT_TRUE(host_clock_run(50000, true)); // an event is news for main
    TEST_ASSERT_EQUAL_UINT64(10000, host_clock_now_ns());
    TEST_ASSERT_EQUAL_UINT(0, ticks);
    host_clock_run(50000, false);
    TEST_ASSERT_EQUAL_UINT(5, ticks);
    TEST_ASSERT_EQUAL_HEX32(1u << 5, seen_at_tick[0]);
    TEST_ASSERT_EQUAL_HEX32(1u << 5, seen_at_tick[1]);
    TEST_ASSERT_EQUAL_HEX32(1u << 5, seen_at_tick[2]);
    TEST_ASSERT_EQUAL_HEX32(1u << 5, seen_at_tick[3]); // last of a time's events wins for GPIO 6
    TEST_ASSERT_EQUAL_HEX32(3u << 5, seen_at_tick[4]);
    TEST_ASSERT_EQUAL_UINT64(HOST_CLOCK_NEVER, host_inputs_next_ns());
    hal_tick_stop();
}

static void load(void *path) {
    host_inputs_load(path);
}

static void assert_refused(const char *text, size_t size, const char *reason) {
    char path[64];
    char message[300];
    strcpy(path, fixture_file("bad.csv", text, size));
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(load, path, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, reason), message);
    TEST_ASSERT_EQUAL_PTR(message + strlen(message) - 1, strchr(message, '\n')); // one line
}

#define ASSERT_REFUSED(text, reason) assert_refused(text, sizeof(text) - 1, reason)

static void test_bad_lines_are_refused_with_file_and_line(void) {
    ASSERT_REFUSED("time_ns,gpio,level\n1,2,3\n", "bad.csv:2: level must be 0 or 1");
    ASSERT_REFUSED("1,2\n", "bad.csv:1: gpio must be 0 to 29");
    ASSERT_REFUSED("1,30,0\n", "bad.csv:1: gpio must be 0 to 29");
    ASSERT_REFUSED("1,,0\n", "bad.csv:1: gpio must be 0 to 29");
    ASSERT_REFUSED("-1,2,0\n", "bad.csv:1: time_ns");
    ASSERT_REFUSED("1.5,2,0\n", "bad.csv:1: time_ns");
    ASSERT_REFUSED("99999999999999999999,2,0\n", "bad.csv:1: time_ns");
    ASSERT_REFUSED("1,2,0,1\n", "bad.csv:1: level");
    ASSERT_REFUSED("1,2,0\ntime_ns,gpio,level\n", "bad.csv:2: time_ns");
    ASSERT_REFUSED("1,2,0\n\0binary", "bad.csv:2: not a text file");
}

static void test_a_file_that_cannot_be_read_is_reported(void) {
    char message[300];
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(load, "/nowhere/at/all", message, sizeof message));
    TEST_ASSERT_EQUAL_STRING("stepmite: /nowhere/at/all: No such file or directory\n", message);
    TEST_ASSERT_EQUAL_INT(2, fixture_exit_code(load, "/tmp", message, sizeof message));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_events_come_in_order_of_time_and_before_a_tick_of_the_same_time);
    RUN_TEST(test_bad_lines_are_refused_with_file_and_line);
    RUN_TEST(test_a_file_that_cannot_be_read_is_reported);
    return UNITY_END();
}
