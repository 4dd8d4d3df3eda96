// How each axis is homed and in which order. Context: main loop.
#include "stepper/home_config.h"

#include <math.h>
#include <string.h>

#include "stepper/axis.h"
#include "stepper/limits.h"
#include "stepper/machine.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"

#define SEEK_PART 0.5 // of the axis's speed
#define SEEK_MAX_MM_MIN 3000.0
#define LATCH_PART 0.1 // of seek
#define LATCH_MIN_MM_MIN 60.0
#define TRAVEL_PART 1.5 // of the soft limits' span
#define TRAVEL_MM 1000.0
#define SPEED_UP_MORE_S 0.02 // for the first measurements of a driver at speed

// As stepper_home_t, in half the memory; the position is rounded to steps anyway.
typedef struct {
    float seek, latch, pull_off_mm, max_travel_mm, position_mm;
    stepper_home_end_t end;
} home_t;

static struct {
    home_t axes[STEPPER_HOME_AXES];
    uint8_t groups[STEPPER_HOME_AXES]; // 0: no more
} homes;

void home_config_reset(void) {
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        homes.axes[axis] = (home_t){.latch = (float)STEPPER_HOME_LATCH};
    }
    memcpy(homes.groups, (const uint8_t[]){1u << AXIS_Z, 1u << AXIS_X, 1u << AXIS_Y},
           sizeof homes.groups);
}

err_t stepper_home_config(axis_id_t axis, const stepper_home_t *config) {
    err_t err = rules_check(RULES_DO_HOME_SETTING);
    if (err == ERR_OK) {
        err = stepper_check_axis(axis);
    }
    if (err == ERR_OK) {
        homes.axes[axis] = (home_t){
            .seek = (float)config->seek,
            .latch = (float)config->latch,
            .pull_off_mm = (float)config->pull_off_mm,
            .max_travel_mm = (float)config->max_travel_mm,
            .position_mm = (float)config->position_mm,
            .end = config->end,
        };
    }
    return err;
}

static uint32_t switch_bit(axis_id_t axis, bool max) {
    return 1u << (2 * axis + max);
}

bool home_config_switch(axis_id_t axis, home_switch_t *found) {
    uint32_t assigned = limits_assigned();
    stepper_home_end_t end = homes.axes[axis].end;
    found->max = end == STEPPER_HOME_MAX ||
                 (end == STEPPER_HOME_AUTO && (assigned & switch_bit(axis, false)) == 0);
    found->bit = switch_bit(axis, found->max);
    found->pin = limits_pins(found->bit);
    found->shared = (limits_switches(found->pin) & ~found->bit) != 0;
    found->high = (limits_levels() & found->pin) != 0;
    return (assigned & found->bit) != 0;
}

home_switch_t home_config_switch_of(axis_id_t axis) {
    home_switch_t found;
    home_config_switch(axis, &found);
    return found;
}

bool home_config_is_closed(axis_id_t axis) {
    home_switch_t found = home_config_switch_of(axis);
    return ((hal_pins_read() & found.pin) != 0) == found.high;
}

uint32_t home_config_closed(uint32_t group) {
    uint32_t closed = 0;
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        bool is_one = ((group >> axis) & 1) && home_config_is_closed(axis);
        closed |= (uint32_t)is_one << axis;
    }
    return closed;
}

axis_id_t home_config_on_either_end(uint32_t group) {
    uint32_t closed = home_config_closed(group);
    axis_id_t axis = 0;
    while (axis < STEPPER_HOME_AXES &&
           !(((closed >> axis) & 1) && home_config_switch_of(axis).shared)) {
        axis++;
    }
    return axis;
}

err_t home_config_check(axis_id_t axis) {
    home_switch_t found;
    err_t err = stepper_check_axis(axis);
    if (err == ERR_OK && !home_config_switch(axis, &found)) {
        err = err_raise(ERR_HOME_NO_SWITCH, "%c has no home switch", STEPPER_AXIS_LETTERS[axis]);
    }
    return err;
}

bool home_config_latch_is_set(axis_id_t axis) {
    return homes.axes[axis].latch >= 0.0f;
}

static double seek_mm_s(axis_id_t axis) {
    stepper_home_t home;
    stepper_home_settings(axis, &home);
    return fmin(home.seek / 60.0, (double)axes[axis].velocity);
}

// An S-curve takes up to twice as long as a trapezoid.
static double speed_up_s(axis_id_t axis) {
    return SPEED_UP_MORE_S + 2.0 * seek_mm_s(axis) / (double)axes[axis].acceleration;
}

uint32_t home_config_speed_up_us(axis_id_t axis) {
    return (uint32_t)(1e6 * speed_up_s(axis));
}

double home_config_speed_up_mm(axis_id_t axis) {
    double speed = seek_mm_s(axis);
    return speed * (speed_up_s(axis) - 0.5 * speed / (double)axes[axis].acceleration);
}

bool stepper_home_halts(axis_id_t axis) {
    float latch = homes.axes[axis].latch;
    return latch == 0.0f || (latch < 0.0f && home_config_switch_of(axis).high);
}

uint32_t home_config_all(void) {
    uint32_t all = 0;
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        home_switch_t found;
        bool homes_there = axes[axis].configured && home_config_switch(axis, &found);
        all |= (uint32_t)homes_there << axis;
    }
    return all;
}

static double given_or(float given, double otherwise) {
    return given > 0.0f ? (double)given : otherwise;
}

void stepper_home_settings(axis_id_t axis, stepper_home_t *settings) {
    const home_t *home = &homes.axes[axis];
    const axis_t *a = &axes[axis];
    home_switch_t found;
    if (home_config_switch(axis, &found)) {
        settings->end = found.max ? STEPPER_HOME_MAX : STEPPER_HOME_MIN;
    } else {
        settings->end = home->end;
    }
    double seek = fmin(SEEK_PART * 60.0 * (double)a->velocity, SEEK_MAX_MM_MIN);
    settings->seek = given_or(home->seek, seek);
    double latch = fmin(fmax(LATCH_PART * settings->seek, LATCH_MIN_MM_MIN), settings->seek);
    settings->latch = home->latch >= 0.0f ? (double)home->latch : latch;
    settings->pull_off_mm = given_or(home->pull_off_mm, a->config.home_backoff_mm);
    double travel = a->limited ? TRAVEL_PART * (a->max - a->min) : TRAVEL_MM;
    settings->max_travel_mm = given_or(home->max_travel_mm, travel);
    settings->position_mm = (double)home->position_mm;
}

err_t stepper_home_order(const uint8_t groups[STEPPER_HOME_AXES]) {
    err_t err = rules_check(RULES_DO_HOME_SETTING);
    uint32_t seen = 0;
    for (unsigned n = 0; n < STEPPER_HOME_AXES && err == ERR_OK; n++) {
        if ((seen & groups[n]) != 0) {
            err = err_raise(ERR_HOME_ORDER, NULL);
        }
        seen |= groups[n];
    }
    if (err == ERR_OK) {
        memcpy(homes.groups, groups, sizeof homes.groups);
    }
    return err;
}

void stepper_home_groups(uint8_t groups[STEPPER_HOME_AXES]) {
    memcpy(groups, homes.groups, sizeof homes.groups);
}

// An axis that does not brake would throw the others of its group out of step, and gets its
// position from an approach in which they would disturb it: it is homed alone.
static uint32_t alone_if_it_must(uint32_t group) {
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        if (((group >> axis) & 1) && stepper_home_halts(axis)) {
            return 1u << axis;
        }
    }
    return group;
}

uint32_t home_config_next(uint32_t left) {
    for (unsigned n = 0; n < STEPPER_HOME_AXES; n++) {
        if ((homes.groups[n] & left) != 0) {
            return alone_if_it_must(homes.groups[n] & left);
        }
    }
    return left & (0u - left); // the lowest
}
