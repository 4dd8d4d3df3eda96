// Context: main loop.
#include "probes.h"

#include <math.h>
#include <stdbool.h>

#include "host_pads.h"
#include "host_tick.h"
#include "model.h"
#include "preempt.h"
#include "stepper/stepper_homing.h"
#include "tests/fuzz/fuzz_random.h"
#include "tests/unit/stepper/watch.h"

#define PROBE_GPIO 16u
#define REACH 400 // hundredths of a unit from zero

static struct {
    bool done;
    int32_t steps[AXIS_COUNT];
} contact;

// Not in the tick: its look at the inputs may be over and its steps may still come.
static void touch(void) {
    if (host_tick_context() == HOST_TICK_TICK) {
        preempt_do_soon(touch);
        return;
    }
    host_pads_drive(PROBE_GPIO, false);
    watch_position(contact.steps);
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
