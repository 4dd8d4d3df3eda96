// The oracle reads edges; of the machine's own words it takes none that the pins do not confirm.
// Context: main loop.
#include "model.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "host_clock.h"
#include "host_pwm.h"
#include "stepper/machine.h"
#include "stepper/stepper_outputs.h"
#include "tests/unit/stepper/watch.h"

model_t model;
uint64_t model_positions;

const stepper_axis_t model_axes[AXIS_COUNT] = {
    {2, 3, 4, false, 400, 6000, 2000, 3},
    {5, 6, PINS_NONE, false, 400, 3000, 1500, 3},
    {8, 9, PINS_NONE, false, 400, 6000, 4000, 3},
    {11, 12, 13, false, 100, 20000, 5000, 3},
};

void fail(const char *format, ...) {
    va_list args;
    va_start(args, format);
    printf("FAILED: run %llu: ", (unsigned long long)model.seed);
    vprintf(format, args);
    va_end(args);
    printf("\n");
    fflush(stdout);
    exit(1);
}

void check(bool right, const char *what) {
    if (!right) {
        fail("%s", what);
    }
}

void wait_us(unsigned us) {
    host_clock_run(host_clock_now_ns() + us * 1000u, false);
}

void check_status(const stepper_status_t *status) {
    check(status->underruns == 0, "the tick ran dry at speed");
    check(status->blocks_free <= status->blocks, "more free slots than there are");
    check(!model.calm || model.curved || status->executed <= model.entries,
          "more entries executed than queued");
    check(watch_fault() == NULL, watch_fault());
}

void check_position(void) {
    int32_t steps[AXIS_COUNT];
    watch_mark();
    machine_motor_steps(steps);
    model_positions++;
    if (!watch_was_at(steps)) {
        int32_t now[AXIS_COUNT];
        watch_position(now);
        fail("the position is %d %d %d %d; the motors were never there, but are at %d %d %d %d",
             (int)steps[0], (int)steps[1], (int)steps[2], (int)steps[3], (int)now[0], (int)now[1],
             (int)now[2], (int)now[3]);
    }
}

// At rest the spindle turns as it was told last, or as it did when the queue was dropped.
static int spindle_rpm(void) {
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    unsigned slice = HAL_PWM_SLICE(MODEL_SPINDLE_GPIO);
    const hal_pwm_t *pwm = host_pwm_settings(slice);
    unsigned level = pwm->level[HAL_PWM_CHANNEL(MODEL_SPINDLE_GPIO)];
    int rpm = (int)lround((double)level * MODEL_RPM_MAX / (pwm->top + 1));
    check(rpm == (int)lround(outputs.rpm), "the slice has another level than the machine says");
    return rpm;
}

static void check_spindle(void) {
    int expected = model.spindle ? model.rpm : 0;
    if (model.pwm && spindle_rpm() != expected) {
        fail("the spindle has %d rpm instead of %d", spindle_rpm(), expected);
    }
}

void check_end(void) {
    stepper_status_t status;
    stepper_status(&status);
    check_status(&status);
    check_position();
    check_spindle();
    check(status.blocks_free == status.blocks, "entries are left in the queue");
    if (model.curved ? status.executed < model.entries : status.executed != model.entries) {
        fail("%u entries executed, %u were queued", (unsigned)status.executed,
             (unsigned)model.entries);
    }
    int32_t steps[AXIS_COUNT];
    watch_position(steps);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        if (steps[axis] != model.steps[axis]) {
            fail("%c ended at %d steps instead of %d", STEPPER_AXIS_LETTERS[axis], (int)steps[axis],
                 (int)model.steps[axis]);
        }
        if (model.calm && !model.curved && watch_pulses(axis) != model.pulses[axis]) {
            fail("%c made %llu steps, its moves have %llu", STEPPER_AXIS_LETTERS[axis],
                 (unsigned long long)watch_pulses(axis), (unsigned long long)model.pulses[axis]);
        }
    }
}

void check_limits(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT && model.straight; axis++) {
        double excess = watch_excess(axis, 2, model_axes[axis].max_acceleration, 0.0, 0);
        if (excess > 0.0) {
            fail("%c is accelerated by %.0f more than its limit", STEPPER_AXIS_LETTERS[axis],
                 excess);
        }
    }
}

void wait_for_rest(void) {
    uint64_t until_us = hal_time_us() + MODEL_WAIT_US;
    stepper_status_t status;
    for (stepper_status(&status); status.moving || status.stopping; stepper_status(&status)) {
        check(hal_time_us() < until_us, "motion does not end");
        wait_us(1000);
    }
}

void follow_machine(void) {
    stepper_status_t status;
    stepper_status(&status);
    check(status.blocks_free == status.blocks, "a stop left entries in the queue");
    model.entries = status.executed;
    double target[AXIS_COUNT];
    stepper_target(target);
    watch_position(model.steps);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        check(lround(target[axis] * model_axes[axis].steps_per_unit) == model.steps[axis],
              "after a stop the next move does not start where the motors stand");
    }
    model.place_known = false;
    stepper_outputs_t outputs;
    stepper_outputs(&outputs);
    model.spindle = outputs.turn != STEPPER_SPINDLE_OFF;
    model.rpm = model.pwm ? spindle_rpm() : 0;
}
