// Entries of the motion queue, checked before they are queued. Context: main loop.
#include <math.h>

#include "stepper/alarm.h"
#include "stepper/arc.h"
#include "stepper/axis.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/outputs.h"
#include "stepper/rules.h"
#include "stepper/stepper_check.h"

#define TICKS_PER_MS (HAL_TICK_HZ / 1000.0)

err_t stepper_check_axis(axis_id_t axis) {
    return axes[axis].configured
               ? ERR_OK
               : err_raise(ERR_AXIS_NOT_CONFIGURED, "%c", STEPPER_AXIS_LETTERS[axis]);
}

// Half a step of tolerance: a limit that is no whole step must not refuse its own value.
bool stepper_is_beyond(axis_id_t axis, double low, double high) {
    double tolerance = 0.5 / axes[axis].config.steps_per_unit;
    return axes[axis].limited &&
           (low < axes[axis].min - tolerance || high > axes[axis].max + tolerance);
}

static err_t check_reach(axis_id_t axis, double low, double high) {
    if (stepper_is_beyond(axis, low, high)) {
        return err_raise(ERR_SOFT_LIMIT, "%c", STEPPER_AXIS_LETTERS[axis]);
    }
    int32_t steps;
    if (!axis_to_steps(axis, low, &steps) || !axis_to_steps(axis, high, &steps)) {
        return err_raise(ERR_AXIS_TOO_FAR, "%c", STEPPER_AXIS_LETTERS[axis]);
    }
    return ERR_OK;
}

static err_t check_target(const stepper_move_t *move, const double from[AXIS_COUNT],
                          int32_t steps[AXIS_COUNT]) {
    err_t err = ERR_OK;
    for (axis_id_t axis = 0; axis < AXIS_COUNT && err == ERR_OK; axis++) {
        double target = move->target[axis];
        steps[axis] = 0;
        if (!axes[axis].configured) {
            err = target != from[axis] ? stepper_check_axis(axis) : ERR_OK;
            continue;
        }
        if (target != from[axis]) {
            err = check_reach(axis, target, target);
        }
        if (err == ERR_OK && !axis_to_steps(axis, target, &steps[axis])) {
            err = err_raise(ERR_AXIS_TOO_FAR, "%c", STEPPER_AXIS_LETTERS[axis]);
        }
    }
    return err;
}

// The speed that the move sets is that of its block and of those behind it. A move too short to be
// queued leaves a block of its own for it.
static void set_spindle(const stepper_move_t *move) {
    if (move->sets_spindle && outputs.turn != STEPPER_SPINDLE_OFF) {
        outputs.level = outputs_level(move->spindle_rpm);
    }
}

static void push_level(uint16_t before) {
    if (outputs.level != before && !outputs.laser) {
        moves_push_pins(&(block_pins_t){.turn = outputs.turn});
    }
}

err_t stepper_move(const stepper_move_t *move) {
    double from[AXIS_COUNT];
    int32_t steps[AXIS_COUNT];
    err_t err = rules_check(RULES_DO_MOVE);
    if (err == ERR_OK) {
        moves_target(from);
        err = check_target(move, from, steps);
    }
    if (err == ERR_OK) {
        uint16_t level = outputs.level;
        set_spindle(move);
        if (!moves_push_line(move, steps)) {
            push_level(level);
        }
        hal_governor_request();
    }
    return err;
}

// The way of the arc between its ends, also of a whole circle.
static err_t check_arc(const arc_t *arc) {
    err_t err = ERR_OK;
    for (unsigned n = 0; n < 2 && err == ERR_OK; n++) {
        double low, high;
        arc_extent(arc, n, &low, &high);
        err = check_reach(arc->plane[n], low, high);
    }
    return err;
}

// All that can be said of an arc from `from` on.
static err_t check_arc_from(const double from[AXIS_COUNT], const stepper_arc_t *wanted, arc_t *arc,
                            int32_t steps[AXIS_COUNT]) {
    err_t err = ERR_OK;
    for (unsigned n = 0; n < 2 && err == ERR_OK; n++) {
        err = stepper_check_axis(wanted->plane[n]);
    }
    if (err == ERR_OK) {
        err = check_target(&wanted->move, from, steps);
    }
    if (err == ERR_OK) {
        err = arc_measure(arc, wanted, from);
    }
    return err == ERR_OK ? check_arc(arc) : err;
}

err_t stepper_arc(const stepper_arc_t *wanted) {
    double from[AXIS_COUNT];
    int32_t steps[AXIS_COUNT];
    arc_t arc;
    err_t err = rules_check(RULES_DO_MOVE);
    if (err == ERR_OK) {
        moves_target(from);
        err = check_arc_from(from, wanted, &arc, steps);
    }
    if (err == ERR_OK) {
        uint16_t level = outputs.level;
        set_spindle(&wanted->move);
        if (!moves_push_arc(&arc, &wanted->move, steps)) {
            push_level(level);
        }
        hal_governor_request();
    }
    return err;
}

// What forbids any move, room in the queue apart.
static err_t check_later_move(void) {
    err_t err = rules_check(RULES_DO_MOVE);
    return err == ERR_GCODE_BUFFER_FULL ? ERR_OK : err; // which is asked for last
}

err_t stepper_check_line(const double from[AXIS_COUNT], const stepper_move_t *move) {
    int32_t steps[AXIS_COUNT];
    err_t err = check_later_move();
    return err == ERR_OK ? check_target(move, from, steps) : err;
}

err_t stepper_check_arc(const double from[AXIS_COUNT], const stepper_arc_t *wanted) {
    int32_t steps[AXIS_COUNT];
    arc_t arc;
    err_t err = check_later_move();
    return err == ERR_OK ? check_arc_from(from, wanted, &arc, steps) : err;
}

err_t stepper_arc_way(const double from[AXIS_COUNT], const stepper_arc_t *wanted, double *way_mm) {
    arc_t arc;
    err_t err = arc_measure(&arc, wanted, from);
    if (err == ERR_OK) {
        axis_id_t across = (axis_id_t)(AXIS_X + AXIS_Y + AXIS_Z - arc.plane[0] - arc.plane[1]);
        double rise = wanted->move.target[across] - from[across];
        double round = arc_way(&arc);
        *way_mm = sqrt(round * round + rise * rise);
    }
    return err;
}

static err_t dwell(double milliseconds, bool lit) {
    err_t err = rules_check(RULES_DO_ENTRY);
    if (err == ERR_OK) {
        moves_push_dwell((uint32_t)ceil(milliseconds * TICKS_PER_MS), lit);
        hal_governor_request();
    }
    return err;
}

err_t stepper_dwell(double milliseconds) {
    return dwell(milliseconds, false);
}

err_t stepper_laser_dwell(double milliseconds) {
    return dwell(milliseconds, true);
}

void stepper_target(double target[AXIS_COUNT]) {
    machine_follow_stops();
    moves_target(target);
}
