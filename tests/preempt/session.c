// Context: main loop.
#include "session.h"

#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "host_pads.h"
#include "model.h"
#include "preempt.h"
#include "tests/fuzz/fuzz_random.h"
#include "tests/unit/stepper/watch.h"

#define OPERATIONS 14

session_counts_t session_counts;

void session_start(void) {
    commands_start();
    watch_attach(model_axes);
    host_pads_drive(MODEL_ESTOP_GPIO, true);
    host_pads_drive(MODEL_LIMIT_GPIO, true);
}

static void choose_model(uint64_t seed) {
    static const uint32_t sizes[] = {1, 2, 3, 8, 32, 32, 100};
    memset(&model, 0, sizeof model);
    model.seed = seed;
    model.blocks = FUZZ_RANDOM_PICK(sizes);
    model.calm = fuzz_random_percent(70);
    model.straight = model.calm && fuzz_random_percent(70);
    model.curved = !model.straight && fuzz_random_percent(60);
    model.place_known = true;
    model.direction[0] = 1 + (int)fuzz_random_below(3);
    for (axis_id_t axis = 1; axis < AXIS_COUNT; axis++) {
        model.direction[axis] = fuzz_random_between(-2, 2);
    }
}

static void set_up(void) {
    if (command("STEPPER INIT 0.05,%u,GP%u", (unsigned)model.blocks, MODEL_ESTOP_GPIO) != ERR_OK) {
        fail("init: %s", err_message());
    }
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        const stepper_axis_t *config = &model_axes[axis];
        char enable[8] = "0";
        if (config->enable_gpio != PINS_NONE) {
            snprintf(enable, sizeof enable, "GP%u", config->enable_gpio);
        }
        if (command("STEPPER AXIS %c,GP%u,GP%u,%s,0,%g,%g,%g,3", STEPPER_AXIS_LETTERS[axis],
                    config->step_gpio, config->dir_gpio, enable, config->steps_per_unit,
                    config->max_velocity, config->max_acceleration) != ERR_OK) {
            fail("axis: %s", err_message());
        }
    }
    if (command("STEPPER HWLIMITS 0,GP%u,0", MODEL_LIMIT_GPIO) != ERR_OK) {
        fail("hwlimits: %s", err_message());
    }
    model.pwm = fuzz_random_percent(50);
    must(model.pwm ? "STEPPER SPINDLE GP14,,10000,,20000" : "STEPPER SPINDLE GP14");
    if (fuzz_random_percent(50)) {
        must("STEPPER SCURVE 1");
        if (command("STEPPER JERK %d", fuzz_random_between(2, 200) * 1000) != ERR_OK) {
            fail("jerk: %s", err_message());
        }
    }
    must("STEPPER POSITION HOME");
    watch_reset();
    if (fuzz_random_percent(60)) {
        operations_arm();
    }
}

void session_run(uint64_t seed) {
    fuzz_random_seed(seed);
    choose_model(seed);
    preempt_begin(seed);
    set_up();
    for (int i = 0; i < OPERATIONS; i++) {
        operations_do_one();
    }
    operations_resume();
    operations_arm();
    wait_for_rest();
    check_end();
    must("STEPPER CLOSE");
    preempt_end();
    check_limits();
    session_counts.operations = operations_counts;
    session_counts.lines = commands_count;
    session_counts.positions = model_positions;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        session_counts.steps += watch_pulses(axis);
    }
}
