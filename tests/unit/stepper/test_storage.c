// When the flash may be written: not while anything moves or could begin to; the watch over an
// E-STOP input pauses for it and goes on behind it.
#include <string.h>
#include <unity.h>

#include "bench.h"
#include "host_pads.h"
#include "stepper/stepper_safety.h"

static uint8_t page[HAL_STORAGE_PAGE];
static uint32_t place; // of the page written last

void setUp(void) {}
void tearDown(void) {}

static bool write_page(void) {
    place = (place + HAL_STORAGE_PAGE) % HAL_STORAGE_SIZE;
    memset(page, 0x5A, sizeof page);
    bool written = hal_storage_program(place, page);
    TEST_ASSERT_EQUAL(written, *(const uint8_t *)hal_storage_map(place) == 0x5A);
    return written;
}

static void start(void) {
    bench_start();
    host_pads_drive(BENCH_ESTOP_GPIO, true);
}

static void test_written_at_rest_with_an_estop_input_watched(void) {
    start();
    bench_wait_us(50000);
    TEST_ASSERT_TRUE(hal_tick_running());
    TEST_ASSERT_TRUE(write_page());
    TEST_ASSERT_TRUE(hal_storage_is_writable());
    TEST_ASSERT_TRUE(hal_tick_running());
    bench_end();
}

static void test_refused_while_moving_and_not_one_step_lost(void) {
    start();
    bench_move(20, 10, 0, 0, 3000);
    for (int i = 0; i < 40; i++) {
        bench_wait_us(7001);
        TEST_ASSERT_FALSE(write_page());
        TEST_ASSERT_FALSE(hal_storage_erase(0));
    }
    bench_finish(2);
    bench_check_positions();
    TEST_ASSERT_TRUE(write_page());
    bench_end();
}

static void test_refused_while_motion_is_held_or_jogs(void) {
    start();
    bench_move(20, 0, 0, 0, 3000);
    bench_wait_us(100000);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(true));
    bench_wait_us(2000000);
    TEST_ASSERT_FALSE(write_page()); // one key lets it go on
    TEST_ASSERT_EQUAL(ERR_OK, stepper_hold(false));
    bench_finish(2);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_jog(AXIS_X, 1, 60));
    bench_wait_us(100000);
    TEST_ASSERT_FALSE(write_page());
    bench_finish(3);
    TEST_ASSERT_TRUE(write_page());
    bench_check_positions();
    bench_end();
}

static void test_what_waits_for_run_does_not_keep_from_writing(void) {
    start();
    bench_finish(1);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_estop()); // disarmed
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    bench_move(5, 0, 0, 0, 3000);
    TEST_ASSERT_TRUE(write_page());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    TEST_ASSERT_FALSE(write_page());
    bench_finish(2);
    bench_check_positions();
    bench_end();
}

// The end of the way is in the tick's hands and takes another millisecond.
static void test_waits_for_what_is_all_but_over(void) {
    start();
    bench_move(1, 0, 0, 0, 3000);
    stepper_status_t status;
    for (stepper_status(&status); status.blocks_free < status.blocks; stepper_status(&status)) {
        bench_wait_us(50);
    }
    TEST_ASSERT_TRUE(write_page());
    bench_check_positions();
    bench_end();
}

static void test_an_estop_pressed_meanwhile_acts_behind_the_write(void) {
    start();
    bench_wait_us(50000);
    TEST_ASSERT_TRUE(hal_on_storage_begin());
    TEST_ASSERT_FALSE(hal_tick_running());
    host_pads_drive(BENCH_ESTOP_GPIO, false);
    bench_wait_us(45000);
    TEST_ASSERT_EQUAL(STEPPER_EVENT_NONE, stepper_next_event());
    hal_on_storage_end();
    bench_wait_us(20);
    TEST_ASSERT_EQUAL(STEPPER_EVENT_ESTOP, stepper_next_event());
    TEST_ASSERT_TRUE(write_page()); // the tick rests after a stop
    TEST_ASSERT_FALSE(hal_tick_running());
    host_pads_drive(BENCH_ESTOP_GPIO, true);
    bench_end();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_written_at_rest_with_an_estop_input_watched);
    RUN_TEST(test_refused_while_moving_and_not_one_step_lost);
    RUN_TEST(test_refused_while_motion_is_held_or_jogs);
    RUN_TEST(test_what_waits_for_run_does_not_keep_from_writing);
    RUN_TEST(test_waits_for_what_is_all_but_over);
    RUN_TEST(test_an_estop_pressed_meanwhile_acts_behind_the_write);
    return UNITY_END();
}
