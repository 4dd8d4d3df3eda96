// Watches the machine from outside: its pins and its reports.
#include "fuzz_machine.h"

#include <math.h>
#include <string.h>

#include "fuzz_drivers.h"
#include "fuzz_session.h"
#include "gcode/gcode.h"
#include "gcode/gcode_job.h"
#include "simulate.h"
#include "stepper/stepper_homing.h"

#define TICK_NS 10000u
#define DISARMED_US 200000u // behind a cycle homing has disarmed its drivers

static struct {
    int32_t pulses[AXIS_COUNT]; // up minus down, since the start
    int32_t base[AXIS_COUNT];   // reported position minus pulses
    uint64_t step_ns[AXIS_COUNT];
    uint64_t dir_ns[AXIS_COUNT];
} machine;

static void watch_axis(axis_id_t axis, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    stepper_axis_t config;
    if (!stepper_axis_config(axis, &config)) {
        return;
    }
    if ((changed & pins_mask(config.dir_gpio)) != 0) {
        machine.dir_ns[axis] = time_ns;
    }
    if ((changed & levels & pins_mask(config.step_gpio)) == 0) {
        return;
    }
    FUZZ_SESSION_CHECK(machine.step_ns[axis] == 0 || time_ns - machine.step_ns[axis] >= 2 * TICK_NS,
                       "axis %d: two steps within %u ns", axis,
                       (unsigned)(time_ns - machine.step_ns[axis]));
    FUZZ_SESSION_CHECK(machine.dir_ns[axis] == 0 || time_ns - machine.dir_ns[axis] >= TICK_NS,
                       "axis %d: a step %u ns after a change of direction", axis,
                       (unsigned)(time_ns - machine.dir_ns[axis]));
    machine.step_ns[axis] = time_ns;
    fuzz_session->steps++;
    if (fuzz_session_plant_now(FUZZ_PLANT_LOST_STEP)) {
        return;
    }
    bool up = ((levels & pins_mask(config.dir_gpio)) != 0) != config.dir_invert;
    machine.pulses[axis] += up ? 1 : -1;
}

static void watch(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    (void)state;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        watch_axis(axis, time_ns, changed, levels);
    }
}

void fuzz_machine_watch(void) {
    FUZZ_SESSION_CHECK(simulate_observe(watch, NULL), "no room for an observer");
}

// Behind its end homing disarms for a moment.
static bool homing_may_write(void) {
    static uint64_t seen_us;
    bool homes = stepper_cycle() != STEPPER_CYCLE_NONE;
    seen_us = homes ? hal_time_us() : seen_us;
    return homes || (seen_us != 0 && hal_time_us() - seen_us < DISARMED_US);
}

void fuzz_machine_look(fuzz_machine_t *now) {
    stepper_status_t status;
    stepper_status(&status);
    *now = (fuzz_machine_t){
        .initialized = status.initialized,
        .armed = status.armed,
        .position_known = status.position_known,
        .changing = status.stopping || status.jogging || gcode_busy() || gcode_job_runs() ||
                    stepper_cycle() != STEPPER_CYCLE_NONE,
        .queued = status.executed + status.blocks - status.blocks_free,
        .driver_writes = fuzz_drivers_writes(),
        .arming = homing_may_write(),
    };
    stepper_target(now->target);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        now->offset[axis] = gcode_offset(axis);
        now->configured[axis] = stepper_axis_configured(axis);
    }
}

void fuzz_machine_check_unchanged(const fuzz_machine_t *before) {
    fuzz_machine_t now;
    fuzz_machine_look(&now);
    FUZZ_SESSION_CHECK(now.driver_writes == before->driver_writes || before->arming || now.arming,
                       "a refused line wrote %u registers of motor drivers",
                       (unsigned)(now.driver_writes - before->driver_writes));
    if (before->changing) {
        return;
    }
    FUZZ_SESSION_CHECK(now.initialized == before->initialized,
                       "a refused line initialised or closed");
    FUZZ_SESSION_CHECK(now.queued == before->queued,
                       "a refused line changed the queue by %d entries",
                       (int)(now.queued - before->queued));
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        FUZZ_SESSION_CHECK(now.target[axis] == before->target[axis],
                           "a refused line moved the target of axis %d from %.17g to %.17g", axis,
                           before->target[axis], now.target[axis]);
        FUZZ_SESSION_CHECK(now.offset[axis] == before->offset[axis],
                           "a refused line changed the offset of axis %d", axis);
        FUZZ_SESSION_CHECK(now.configured[axis] == before->configured[axis],
                           "a refused line changed the configuration of axis %d", axis);
    }
}

void fuzz_machine_rebase(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        machine.base[axis] = stepper_position_steps(axis) - machine.pulses[axis];
    }
}

void fuzz_machine_check_pulses(void) {
    stepper_status_t status;
    stepper_status(&status);
    FUZZ_SESSION_CHECK(status.underruns == 0, "the tick ran dry at speed %u times",
                       (unsigned)status.underruns);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        int32_t moved = stepper_position_steps(axis) - machine.base[axis];
        FUZZ_SESSION_CHECK(!stepper_axis_configured(axis) || moved == machine.pulses[axis],
                           "axis %d says it moved %d steps, its pins say %d", axis, (int)moved,
                           (int)machine.pulses[axis]);
    }
}

bool fuzz_machine_is_moving(void) {
    stepper_status_t status;
    stepper_status(&status);
    return status.moving && (!status.holding || hal_tick_running());
}

static bool wait_for_rest(double limit_s) {
    uint64_t until_us = hal_time_us() + (uint64_t)(limit_s * 1e6);
    while (fuzz_machine_is_moving() && hal_time_us() < until_us) {
        hal_idle(until_us);
        stepper_background();
    }
    return !fuzz_machine_is_moving();
}

static void check_on_target(void) {
    double target[AXIS_COUNT];
    stepper_target(target);
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        stepper_axis_t config;
        if (!stepper_axis_config(axis, &config)) {
            continue;
        }
        double wanted_steps = target[axis] * config.steps_per_unit;
        double error_steps = fabs(wanted_steps - stepper_position_steps(axis));
        FUZZ_SESSION_CHECK(error_steps <= 0.5 + 1e-12 * fabs(wanted_steps),
                           "axis %d ended %g steps beside its target %.17g", axis, error_steps,
                           target[axis]);
    }
}

bool fuzz_machine_settle(double limit_s) {
    bool by_itself = wait_for_rest(limit_s);
    if (!by_itself) {
        stepper_stop();
        if (!wait_for_rest(limit_s)) {
            stepper_estop();
            stepper_background();
        }
    }
    FUZZ_SESSION_CHECK(!fuzz_machine_is_moving(), "still moving after an emergency stop");
    fuzz_machine_check_pulses();
    stepper_status_t status;
    stepper_status(&status);
    if (status.initialized && status.blocks == status.blocks_free) {
        check_on_target();
    }
    return by_itself;
}
