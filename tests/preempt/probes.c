// Context: main loop.
#include "probes.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "host_clock.h"
#include "host_pads.h"
#include "host_tick.h"
#include "model.h"
#include "preempt.h"
#include "stepper/stepper_homing.h"
#include "stepper/stepper_safety.h"
#include "tests/fuzz/fuzz_random.h"
#include "tests/unit/stepper/watch.h"

#define PROBE_GPIO 16u
#define REACH 400 // hundredths of a unit from zero

static struct {
    uint8_t gpio;
    bool done;
    uint64_t ns;
    int32_t steps[AXIS_COUNT];
} contact;

// Not in the tick: its look at the inputs may be over and its steps may still come.
static void touch(void) {
    if (host_tick_context() == HOST_TICK_TICK) {
        preempt_do_soon(touch);
        return;
    }
    host_pads_drive(contact.gpio, false);
    watch_position(contact.steps);
    contact.ns = host_clock_now_ns();
    contact.done = true;
}

static void look(unsigned us) {
    wait_us(us);
    stepper_background();
    check_position();
}

static void check_place(void) {
    double place[AXIS_COUNT];
    bool changed = stepper_probed(place);
    check(contact.done || !changed, "the probe has changed by itself");
    for (axis_id_t axis = 0; axis < AXIS_COUNT && changed; axis++) {
        int32_t steps = (int32_t)lround(place[axis] * model_axes[axis].steps_per_unit);
        if (steps != contact.steps[axis]) {
            fail("probed at %d steps of %c, it was at %d", (int)steps, STEPPER_AXIS_LETTERS[axis],
                 (int)contact.steps[axis]);
        }
    }
}

void probes_do_one(void) {
    stepper_move_t move = {.feed = fuzz_random_between(1, 80) * 100};
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        move.target[axis] = fuzz_random_between(-REACH, REACH) / 100.0;
    }
    host_pads_drive(PROBE_GPIO, true);
    contact.gpio = PROBE_GPIO;
    contact.done = false;
    check(stepper_probe_pin(PROBE_GPIO, false) == ERR_OK, err_message());
    err_t err = stepper_probe(&move, false, false);
    check(err == ERR_OK || err == ERR_PROBE_NO_WAY, err_message());
    look(fuzz_random_below(60000));
    preempt_do_soon(touch);
    while (stepper_cycle() != STEPPER_CYCLE_NONE) {
        look(fuzz_random_below(2000));
    }
    preempt_do_soon(NULL);
    if (err == ERR_OK && stepper_cycle_result() == ERR_OK) {
        check_place();
    }
}

// ---- Homing -------------------------------------------------------------------------------------

#define PULL_OFF_STEPS (3 * 400)
#define SAMPLES 3u
#define TICK_NS 10000u

static bool does(const char *phase) {
    uint32_t axes;
    return stepper_cycle() == STEPPER_CYCLE_HOMING &&
           strcmp(stepper_homing_phase(&axes), phase) == 0;
}

static void check_halt(void) {
    int32_t steps[AXIS_COUNT];
    watch_position(steps);
    int32_t lost = contact.steps[AXIS_Y] - steps[AXIS_Y];
    if (watch_last_step_ns() > contact.ns + (SAMPLES + 1) * TICK_NS || lost < 0 || lost > 2) {
        fail("%d steps behind the stall, the last one %d us", (int)lost,
             (int)((int64_t)(watch_last_step_ns() - contact.ns) / 1000));
    }
}

static void let_it_stall(void) {
    while (does("waiting for the queue")) {
        look(200);
    }
    look(fuzz_random_below(60000));
    preempt_do_soon(touch);
    while (does("approaching the switch") && !contact.done) {
        look(fuzz_random_below(2000));
    }
    check(contact.done, "homing has ended by itself");
    look(1000);
    check_halt();
    host_pads_drive(MODEL_LIMIT_GPIO, true);
}

void probes_home_one(void) {
    const stepper_home_t home = {.seek = fuzz_random_between(1, 30) * 100, .latch = 0.0};
    contact.gpio = MODEL_LIMIT_GPIO;
    contact.done = false;
    check(stepper_filter(SAMPLES, 1) == ERR_OK, err_message());
    check(stepper_home_config(AXIS_Y, &home) == ERR_OK, err_message());
    check(stepper_home(1u << AXIS_Y) == ERR_OK, err_message());
    let_it_stall();
    preempt_do_soon(NULL);
    while (stepper_cycle() != STEPPER_CYCLE_NONE) {
        wait_us(fuzz_random_below(2000)); // the position becomes that of the home place
        stepper_background();
    }
    check(stepper_cycle_result() == ERR_OK, err_message());
    int32_t steps[AXIS_COUNT];
    watch_position(steps);
    int32_t away = steps[AXIS_Y] - contact.steps[AXIS_Y] - PULL_OFF_STEPS;
    check(away >= -1 && away <= 0, "the home place is not that of the stall");
    check(stepper_alarm() == STEPPER_ALARM_NONE, "a stall is no alarm");
}
