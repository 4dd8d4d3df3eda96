#include "bench.h"

#include <string.h>
#include <unity.h>

#include "host_clock.h"

bench_t bench;

const stepper_axis_t bench_axes[AXIS_COUNT] = {
    {2, 3, 4, false, 80, 6000, 500, 3},
    {5, 6, 7, false, 80, 6000, 500, 3},
    {8, 9, 10, true, 400, 1200, 200, 3},
    {11, 12, PINS_NONE, false, 10, 36000, 2000, 3},
};

static uint64_t last_step_ns[AXIS_COUNT];
static uint64_t last_dir_ns[AXIS_COUNT];

static void watch(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    (void)state;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (changed & pins_mask(bench_axes[axis].dir_gpio)) {
            last_dir_ns[axis] = time_ns;
            uint64_t hold = time_ns - last_step_ns[axis];
            if (last_step_ns[axis] != 0 && hold < bench.min_dir_hold_ns) {
                bench.min_dir_hold_ns = hold;
            }
        }
        if ((changed & levels & pins_mask(bench_axes[axis].step_gpio)) == 0) {
            continue;
        }
        uint64_t gap = time_ns - last_step_ns[axis];
        uint64_t setup = time_ns - last_dir_ns[axis];
        if (last_step_ns[axis] != 0 && gap < bench.min_step_gap_ns) {
            bench.min_step_gap_ns = gap;
        }
        if (setup < bench.min_dir_setup_ns) {
            bench.min_dir_setup_ns = setup;
        }
        last_step_ns[axis] = time_ns;
        bench.last_step_ns = time_ns;
    }
}

static void attach_once(void) {
    static bool attached;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        bench.motors[axis] = (simulate_axis_t){
            .step_gpio = bench_axes[axis].step_gpio,
            .dir_gpio = bench_axes[axis].dir_gpio,
            .dir_inverted = bench_axes[axis].dir_invert,
        };
        if (!attached) {
            TEST_ASSERT_TRUE(simulate_axis_attach(&bench.motors[axis]));
        }
    }
    if (!attached) {
        TEST_ASSERT_TRUE(simulate_observe(watch, NULL));
    }
    attached = true;
}

err_t bench_spindle(uint8_t gpio, bool invert) {
    return stepper_spindle(&(stepper_spindle_t){
        .gpio = gpio,
        .dir_gpio = PINS_NONE,
        .invert = invert,
    });
}

static void start(const stepper_axis_t configs[AXIS_COUNT], uint32_t blocks, bool keeps_enabled) {
    attach_once();
    stepper_init_t init = {0.05, blocks, BENCH_ESTOP_GPIO, keeps_enabled};
    TEST_ASSERT_EQUAL(ERR_OK, stepper_init(&init));
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_axis(axis, &configs[axis]), err_message());
    }
    TEST_ASSERT_EQUAL(ERR_OK, bench_spindle(BENCH_SPINDLE_GPIO, false));
    TEST_ASSERT_EQUAL(ERR_OK, stepper_set_home());
    TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
    bench_wait_us(1000);
    bench.min_step_gap_ns = bench.min_dir_setup_ns = bench.min_dir_hold_ns = UINT64_MAX;
    memset(last_step_ns, 0, sizeof last_step_ns);
    memset(last_dir_ns, 0, sizeof last_dir_ns);
}

void bench_start(void) {
    start(bench_axes, STEPPER_BLOCKS_DEFAULT, false);
}

void bench_start_with(const stepper_axis_t *config, uint32_t blocks, bool estop_keeps_enabled) {
    stepper_axis_t configs[AXIS_COUNT];
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        configs[axis] = config != NULL ? *config : bench_axes[axis];
        configs[axis].step_gpio = bench_axes[axis].step_gpio;
        configs[axis].dir_gpio = bench_axes[axis].dir_gpio;
        configs[axis].enable_gpio = bench_axes[axis].enable_gpio;
        configs[axis].dir_invert = bench_axes[axis].dir_invert;
    }
    start(configs, blocks, estop_keeps_enabled);
}

void bench_end(void) {
    stepper_status_t status;
    stepper_status(&status);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, status.underruns, "the tick ran dry in a motion");
    TEST_ASSERT_EQUAL(ERR_OK, stepper_close());
}

void bench_wait_us(uint64_t us) {
    host_clock_run(host_clock_now_ns() + us * 1000, false);
}

void bench_move(double x, double y, double z, double a, double feed) {
    while (stepper_blocks_free() == 0) {
        bench_wait_us(500);
    }
    stepper_move_t move = {.target = {x, y, z, a}, .feed = feed, .rapid = feed == 0.0};
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_move(&move), err_message());
}

double bench_finish(double limit_s) {
    uint64_t begin_us = hal_time_us();
    while (stepper_active() > 0) {
        TEST_ASSERT_TRUE_MESSAGE((double)(hal_time_us() - begin_us) < limit_s * 1e6,
                                 "motion does not end");
        bench_wait_us(100);
    }
    return (double)(hal_time_us() - begin_us) * 1e-6;
}

void bench_check_positions(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        TEST_ASSERT_EQUAL_INT64(bench.motors[axis].position_steps, stepper_position_steps(axis));
    }
}
