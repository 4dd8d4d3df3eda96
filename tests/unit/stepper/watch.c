// One observer for all axes, since it is called at every edge of the runs. Context: any.
#include "watch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simulate.h"

#define TICK_NS 10000u
#define STEPS_MAX 400000u // of one axis in one run
#define PLACES_MAX 4096u  // since watch_mark()

typedef struct {
    uint32_t step_pin, dir_pin;
    bool dir_inverted;
    double steps_per_unit;
    int32_t position;
    uint64_t step_ns, dir_ns; // last edges
    uint32_t count;
    watch_step_t steps[STEPS_MAX];
    int32_t place;
} motor_t;

static struct {
    motor_t motors[AXIS_COUNT];
    uint64_t start_ns;
    uint64_t last_step_ns;
    const char *fault;
    bool marked;
    unsigned places;
    int32_t place[PLACES_MAX][AXIS_COUNT];
} watch;

static void remember_place(void) {
    if (watch.marked && watch.places < PLACES_MAX) {
        watch_position(watch.place[watch.places++]);
    }
}

static void take_step(motor_t *motor, uint64_t time_ns, bool up) {
    if (motor->step_ns != 0 && time_ns - motor->step_ns < 2 * TICK_NS) {
        watch.fault = "two steps within two ticks";
    }
    if (motor->dir_ns != 0 && time_ns - motor->dir_ns < TICK_NS) {
        watch.fault = "a step in the tick in which the direction changed";
    }
    motor->position += up ? 1 : -1;
    motor->place += up ? 1 : -1;
    motor->step_ns = time_ns;
    watch.last_step_ns = time_ns;
    if (motor->count < STEPS_MAX) {
        motor->steps[motor->count].tick = (uint32_t)((time_ns - watch.start_ns) / TICK_NS);
        motor->steps[motor->count].place = motor->place;
        motor->count++;
    } else {
        watch.fault = "more steps than a run may have";
    }
}

static void on_edges(void *state, uint64_t time_ns, uint32_t changed, uint32_t levels) {
    (void)state;
    bool stepped = false;
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        motor_t *motor = &watch.motors[axis];
        if ((changed & motor->dir_pin) != 0) {
            motor->dir_ns = time_ns;
            if (motor->step_ns != 0 && time_ns - motor->step_ns < TICK_NS) {
                watch.fault = "the direction changed in the tick of a step";
            }
        }
        if ((changed & levels & motor->step_pin) != 0) {
            take_step(motor, time_ns, ((levels & motor->dir_pin) != 0) != motor->dir_inverted);
            stepped = true;
        }
    }
    if (stepped) {
        remember_place();
    }
}

void watch_attach(const stepper_axis_t axes[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        watch.motors[axis].step_pin = pins_mask(axes[axis].step_gpio);
        watch.motors[axis].dir_pin = pins_mask(axes[axis].dir_gpio);
        watch.motors[axis].dir_inverted = axes[axis].dir_invert;
        watch.motors[axis].steps_per_unit = axes[axis].steps_per_unit;
    }
    if (!simulate_observe(on_edges, NULL)) {
        abort();
    }
}

void watch_reset(void) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        motor_t *motor = &watch.motors[axis];
        motor->position = 0;
        motor->place = 0;
        motor->count = 0;
        motor->step_ns = motor->dir_ns = 0;
    }
    watch.start_ns = hal_time_us() * 1000;
    watch.last_step_ns = 0;
    watch.fault = NULL;
    watch.marked = false;
}

void watch_set_position(const int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        watch.motors[axis].position = steps[axis];
    }
}

void watch_position(int32_t steps[AXIS_COUNT]) {
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        steps[axis] = watch.motors[axis].position;
    }
}

uint64_t watch_pulses(axis_id_t axis) {
    return watch.motors[axis].count;
}

const watch_step_t *watch_steps(axis_id_t axis) {
    return watch.motors[axis].steps;
}

uint64_t watch_last_step_ns(void) {
    return watch.last_step_ns;
}

void watch_mark(void) {
    watch.marked = true;
    watch.places = 0;
    remember_place();
}

bool watch_was_at(const int32_t steps[AXIS_COUNT]) {
    watch.marked = false;
    for (unsigned i = 0; i < watch.places; i++) {
        if (memcmp(steps, watch.place[i], sizeof watch.place[i]) == 0) {
            return true;
        }
    }
    return watch.places == PLACES_MAX; // too many to tell
}

const char *watch_fault(void) {
    return watch.fault;
}

// ---- Limits -------------------------------------------------------------------------------------

#define ORDERS 3
#define WINDOWS 3

// Place at `tick`, for ticks that do not go back; `index` keeps where the search is.
static int32_t place_at(const motor_t *motor, uint32_t tick, uint32_t *index) {
    while (*index < motor->count && motor->steps[*index].tick <= tick) {
        ++*index;
    }
    return *index > 0 ? motor->steps[*index - 1].place : 0;
}

// By how much the greatest difference of that order over windows of `ticks` is more than `allowed`
// steps.
static double excess_steps(const motor_t *motor, unsigned order, uint32_t ticks, double allowed,
                           uint32_t from) {
    static const int binomial[ORDERS + 1][ORDERS + 1] = {{1}, {-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}};
    double worst = 0.0;
    uint32_t last = motor->steps[motor->count - 1].tick;
    uint32_t index[ORDERS + 1] = {0};
    for (uint32_t tick = from; tick < last; tick += ticks / 8) {
        int32_t difference = 0;
        for (unsigned i = 0; i <= order; i++) {
            difference += binomial[order][i] * place_at(motor, tick + i * ticks, &index[i]);
        }
        worst = fmax(worst, abs(difference) - allowed);
    }
    return worst;
}

double watch_excess(axis_id_t axis, unsigned order, double limit, double jump, uint64_t from_ns) {
    static const uint32_t windows[ORDERS + 1][WINDOWS] = {
        {0}, {50, 200, 1000}, {160, 400, 1000}, {500, 1000, 2000}};
    const motor_t *motor = &watch.motors[axis];
    uint32_t from = from_ns > watch.start_ns ? (uint32_t)((from_ns - watch.start_ns) / TICK_NS) : 0;
    double worst = 0.0;
    for (unsigned i = 0; i < WINDOWS && motor->count > 0; i++) {
        double window_s = windows[order][i] * (TICK_NS * 1e-9);
        double steps_per_limit = motor->steps_per_unit * pow(window_s, order);
        // A place is known to half a step and to the way of a tick, at most half a step as well but
        // hardly at all four places; they add up by the binomials.
        double grid = 0.75 * (1 << order);
        double allowed = limit * 1.02 * steps_per_limit +
                         (order > 1 ? jump * motor->steps_per_unit * window_s * (order - 1) : 0.0) +
                         grid;
        worst = fmax(worst, excess_steps(motor, order, windows[order][i], allowed, from) /
                                steps_per_limit);
    }
    return worst;
}
