#include "homing_bench.h"

#include <string.h>
#include <unity.h>

#include "host_pads.h"

#define BOUNCE_US 700u
#define HYSTERESIS 5u
#define START_STEPS 4000
#define POLL_US 250u

#define SWITCH(axis_id, pin, from, to)                                                             \
    {.axis = &bench.motors[axis_id],                                                               \
     .gpio = (pin),                                                                                \
     .from_steps = (from),                                                                         \
     .to_steps = (to),                                                                             \
     .hysteresis_steps = HYSTERESIS,                                                               \
     .bounce_us = BOUNCE_US}

simulate_switch_t homing_switches[SWITCH_COUNT] = {
    [SWITCH_X_MIN] = SWITCH(AXIS_X, 16, INT32_MIN, 0),
    [SWITCH_X_MAX] = SWITCH(AXIS_X, 17, 20000, INT32_MAX),
    [SWITCH_Y_MIN] = SWITCH(AXIS_Y, 18, INT32_MIN, 0),
    [SWITCH_Z_MAX] = SWITCH(AXIS_Z, 20, 0, INT32_MAX),
    [SWITCH_PROBE] = {.axis = &bench.motors[AXIS_X],
                      .gpio = PROBE_GPIO,
                      .from_steps = INT32_MIN,
                      .to_steps = 0},
};

static void attach_once(void) {
    static bool attached;
    for (unsigned i = 0; i < SWITCH_COUNT && !attached; i++) {
        TEST_ASSERT_TRUE(simulate_switch_attach(&homing_switches[i]));
    }
    attached = true;
}

static void assign(bool all) {
    stepper_hwlimits_t switches = {.gpio = {16, 17, 18, PINS_NONE, PINS_NONE, 20}};
    if (!all) {
        memset(switches.gpio, PINS_NONE, sizeof switches.gpio);
    }
    TEST_ASSERT_EQUAL_MESSAGE(ERR_OK, stepper_hwlimits(&switches), err_message());
}

void homing_bench_put(axis_id_t axis, int64_t steps) {
    assign(false); // or a switch that it is put on would trip
    bench.motors[axis].position_steps = steps;
    for (unsigned i = 0; i < SWITCH_COUNT; i++) {
        simulate_switch_t *at = &homing_switches[i];
        if (at->axis != &bench.motors[axis] || at->stall_rate_hz > 0) {
            continue;
        }
        at->pressed = (steps >= at->from_steps && steps <= at->to_steps) ||
                      at->fault == SIMULATE_FAULT_NEVER_OPENS;
        at->closed = at->pressed;
        at->edge_ns = 0;
        host_pads_drive(at->gpio, at->pressed == at->pressed_level);
    }
    assign(true);
}

static bool curved;

void homing_bench_scurve(bool on) {
    curved = on;
}

void homing_bench_start(bool known) {
    for (unsigned i = 0; i < SWITCH_COUNT; i++) {
        homing_switches[i].fault = SIMULATE_FAULT_NONE;
    }
    bench_start();
    TEST_ASSERT_EQUAL(ERR_OK, stepper_scurve(curved));
    attach_once();
    homing_bench_put(AXIS_X, START_STEPS);
    homing_bench_put(AXIS_Y, START_STEPS);
    homing_bench_put(AXIS_Z, -START_STEPS);
    TEST_ASSERT_EQUAL(ERR_OK, stepper_probe_pin(PROBE_GPIO, false));
    if (!known) {
        bench_move(0, 0, 0, 50, 0);
        bench_wait_us(20000);
        TEST_ASSERT_EQUAL(ERR_OK, stepper_estop());
        TEST_ASSERT_EQUAL(ERR_OK, stepper_run(STEPPER_IDLE_HOLD));
        TEST_ASSERT_FALSE(stepper_status_bits() & STEPPER_STATUS_POSITION_KNOWN);
    }
}

err_t homing_bench_finish(double limit_s) {
    uint64_t begin_us = hal_time_us();
    while (stepper_cycle() != STEPPER_CYCLE_NONE) {
        TEST_ASSERT_TRUE_MESSAGE((double)(hal_time_us() - begin_us) < limit_s * 1e6,
                                 "the cycle does not end");
        bench_wait_us(POLL_US);
        stepper_background();
    }
    return stepper_cycle_result();
}

void homing_bench_reach(axis_id_t axis, const char *phase, unsigned more_us) {
    uint32_t axes = 0;
    for (unsigned n = 0; n < 400000; n++) {
        const char *now = stepper_homing_phase(&axes);
        if (((axes >> axis) & 1) && strcmp(now, phase) == 0) {
            for (unsigned us = 0; us < more_us; us += POLL_US) {
                bench_wait_us(POLL_US);
                stepper_background();
            }
            return;
        }
        TEST_ASSERT_EQUAL_MESSAGE(STEPPER_CYCLE_HOMING, stepper_cycle(), phase);
        bench_wait_us(POLL_US);
        stepper_background();
    }
    TEST_FAIL_MESSAGE(phase);
}
