// The way of a group of axes to their home switches, phase by phase. A phase is one move or more,
// each from standstill to standstill; the machine is at rest whenever something here decides.
//
//   switch closed  |<-- clearance ->                   only if it is closed at the start
//             |<===|================ approach ======   seek feed, ends where the switch closes
//             |====|=========>       run up            only behind a stall while it accelerated
//             |<===|==========       approach again    with its full speed when it gets there
//             |====|======> back off                   to pull_off from there
//                  |<====== refine                     latch feed, ends where the switch closes
//                  |======> pull off                   to pull_off from there: the home position
//
// Context: main loop.
#include "stepper/homing.h"

#include <float.h>
#include <math.h>

#include "stepper/alarm.h"
#include "stepper/axis.h"
#include "stepper/cycle.h"
#include "stepper/homing_hook.h"
#include "stepper/limits.h"
#include "stepper/machine.h"
#include "stepper/rules.h"

typedef enum {
    PHASE_LEAVE,
    PHASE_APPROACH,
    PHASE_RUN_UP,
    PHASE_AGAIN,
    PHASE_BACK_OFF,
    PHASE_REFINE,
    PHASE_PULL_OFF,
    PHASES
} phase_t;

typedef struct {
    const char *doing;
    bool searches; // ends where the switch changes; otherwise at a place, with the switch open
    bool towards;  // the switch
    bool slowly;   // at the latch feed, and only by axes that have one
} phase_row_t;

static const phase_row_t phases[PHASES] = {
    [PHASE_LEAVE] = {"leaving the switch", true, false, false},
    [PHASE_APPROACH] = {"approaching the switch", true, true, false},
    [PHASE_RUN_UP] = {"backing off", false, false, false},
    [PHASE_AGAIN] = {"approaching the switch", true, true, false},
    [PHASE_BACK_OFF] = {"backing off", false, false, false},
    [PHASE_REFINE] = {"approaching slowly", true, true, true},
    [PHASE_PULL_OFF] = {"pulling off", false, false, false},
};

static struct {
    uint8_t wanted; // axes, as masks: to be homed, the group included
    uint8_t group;  // being homed; 0: none yet
    uint8_t todo;   // of the group, in this phase
    uint8_t stalls; // of the group: those without a switch, see notice_stalls()
    uint8_t doubts; // of those: found while they accelerated
    bool moved;     // a move of the phase has been made
    bool settled;   // and the pause behind it
    phase_t phase;
    int32_t start[STEPPER_HOME_AXES]; // of the move, steps
    int32_t place[STEPPER_HOME_AXES]; // where the switch closed
    float left[STEPPER_HOME_AXES];    // mm that may still be searched
    float span[STEPPER_HOME_AXES];    // mm of all of the search
} homing;

#define FOR_AXES(axis, mask)                                                                       \
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++)                                     \
        if (((mask) >> axis) & 1)

// ---- The switches -------------------------------------------------------------------------------

// Units that the axis's coordinate grows by in a mm towards its switch.
static double direction(axis_id_t axis) {
    return home_config_switch_of(axis).max ? 1.0 : -1.0;
}

// True when the drivers are as they should be; otherwise that takes a while, or was the end of the
// cycle.
static bool drivers_are_ready(stepper_arm_t answer) {
    if (answer == STEPPER_ARM_FAILED) {
        cycle_end(CYCLE_DRIVER, 0, 0.0);
    }
    return answer == STEPPER_ARM_DONE;
}

// ---- The way of a phase -------------------------------------------------------------------------

// How far away the switch may change. When the axis last met it, it ran over it while it braked:
// twice the way of a trapezoid, since S-curves take longer.
static double reach(axis_id_t axis, const stepper_home_t *home) {
    double speed = fmin(home->seek / 60.0, (double)axes[axis].velocity);
    double braking = speed * speed / (double)axes[axis].acceleration;
    switch (homing.phase) {
    case PHASE_LEAVE:
        return home->pull_off_mm + braking;
    case PHASE_REFINE:
        return 2.0 * home->pull_off_mm + braking;
    default:
        return home->max_travel_mm;
    }
}

// The axes that take part.
static uint32_t who(phase_t phase) {
    if (phase == PHASE_LEAVE) {
        return home_config_closed(homing.group);
    }
    if (phase == PHASE_RUN_UP || phase == PHASE_AGAIN) {
        return homing.doubts;
    }
    uint32_t refining = 0;
    FOR_AXES(axis, homing.group) {
        stepper_home_t home;
        stepper_home_settings(axis, &home);
        refining |= (uint32_t)(home.latch > 0.0) << axis;
    }
    refining &= ~(uint32_t)homing.stalls;
    return phase == PHASE_BACK_OFF || phase == PHASE_REFINE ? refining : homing.group;
}

static void enter(phase_t phase) {
    homing.phase = phase;
    homing.moved = false;
    homing.todo = (uint8_t)who(phase);
    FOR_AXES(axis, homing.todo) {
        stepper_home_t home;
        stepper_home_settings(axis, &home);
        homing.span[axis] = homing.left[axis] = (float)reach(axis, &home);
    }
}

// The axes of the next move. Slowly only one: it alone decides where its place is latched.
static uint32_t searching(void) {
    return phases[homing.phase].slowly ? homing.todo & (0u - homing.todo) : homing.todo;
}

// All axes of the search go at their own feed, until the first one has used up its way.
static void search(void) {
    const phase_row_t *row = &phases[homing.phase];
    const uint32_t moving = searching();
    double feed[STEPPER_HOME_AXES] = {0};
    double minutes = DBL_MAX;
    double square = 0.0;
    FOR_AXES(axis, moving) {
        stepper_home_t home;
        stepper_home_settings(axis, &home);
        feed[axis] = row->slowly ? home.latch : home.seek;
        minutes = fmin(minutes, (double)homing.left[axis] / feed[axis]);
        square += feed[axis] * feed[axis];
    }
    int32_t target[AXIS_COUNT];
    machine_motor_steps(target);
    cycle_until_t until = {0};
    FOR_AXES(axis, moving) {
        home_switch_t found = home_config_switch_of(axis);
        bool halts = row->towards && !row->slowly && stepper_home_halts(axis);
        until.pins |= found.pin;
        until.levels |= found.high == row->towards ? found.pin : 0;
        until.halts |= halts ? found.pin : 0;
        until.after_us = homing.phase == PHASE_AGAIN ? home_config_speed_up_us(axis) : 0;
        homing.start[axis] = target[axis];
        double way = direction(axis) * (row->towards ? feed[axis] : -feed[axis]) * minutes;
        if (!axis_to_steps(axis, axis_from_steps(axis, target[axis]) + way, &target[axis])) {
            cycle_end(CYCLE_TOO_FAR, 1u << axis, 0.0);
            return;
        }
    }
    cycle_move(target, sqrt(square), &until);
}

// To the place that is pull_off away from the switch, or more if it is to speed up from there.
static void leave(void) {
    double feed = DBL_MAX; // that none of them minds
    int32_t target[AXIS_COUNT];
    machine_motor_steps(target);
    FOR_AXES(axis, homing.todo) {
        stepper_home_t home;
        stepper_home_settings(axis, &home);
        bool runs_up = homing.phase == PHASE_RUN_UP;
        double way = home.pull_off_mm + (runs_up ? home_config_speed_up_mm(axis) : 0.0);
        double to = axis_from_steps(axis, homing.place[axis]) - direction(axis) * way;
        if (!axis_to_steps(axis, to, &target[axis])) {
            cycle_end(CYCLE_TOO_FAR, 1u << axis, 0.0);
            return;
        }
        feed = fmin(feed, home.seek);
    }
    cycle_move(target, feed, NULL);
}

// ---- The ends of moves --------------------------------------------------------------------------

static axis_id_t first_of(uint32_t mask) {
    axis_id_t axis = 0;
    while (axis < STEPPER_HOME_AXES - 1 && ((mask >> axis) & 1) == 0) {
        axis++;
    }
    return axis;
}

// The axis that has used up its way; others of the move have some left.
static axis_id_t first_without_way(uint32_t moved) {
    axis_id_t first = first_of(moved);
    FOR_AXES(axis, moved) {
        first = homing.left[axis] < homing.left[first] ? axis : first;
    }
    return first;
}

static void use_up(uint32_t moved) {
    int32_t now[AXIS_COUNT];
    machine_motor_steps(now);
    FOR_AXES(axis, moved) {
        double way = axis_from_steps(axis, now[axis]) - axis_from_steps(axis, homing.start[axis]);
        homing.left[axis] -= (float)fabs(way);
    }
}

// A switch stays closed when the axis has run over it. The output of a driver that has noticed a
// stall does not, and would notice nothing at a lower speed: what it has found is taken as it is.
// It is active high. Whoever has chosen a latch feed has a switch.
static void notice_stalls(uint32_t moved) {
    FOR_AXES(axis, moved & ~(uint32_t)homing.todo) {
        bool opened = home_config_switch_of(axis).high && !home_config_is_closed(axis);
        bool stalls = opened && !home_config_latch_is_set(axis);
        double way = axis_from_steps(axis, homing.place[axis] - homing.start[axis]);
        bool early = fabs(way) < home_config_speed_up_mm(axis);
        homing.stalls |= (uint8_t)(stalls << axis);
        homing.doubts |= (uint8_t)((stalls && early) << axis);
    }
}

static void end_search(void) {
    const phase_row_t *row = &phases[homing.phase];
    const uint32_t moved = searching();
    int32_t places[AXIS_COUNT];
    uint32_t pins = cycle_moved(places);
    use_up(moved);
    if (pins == 0) {
        axis_id_t axis = first_without_way(moved);
        cycle_end(row->towards ? CYCLE_NEVER_CLOSED : CYCLE_NEVER_OPENED, 1u << axis,
                  (double)homing.span[axis]);
        return;
    }
    FOR_AXES(axis, moved) {
        // Another one may have met its switch while all braked: behind the place where it was then.
        if ((home_config_switch_of(axis).pin & pins) != 0 ||
            home_config_is_closed(axis) == row->towards) {
            homing.place[axis] = places[axis];
            homing.todo &= (uint8_t)~(1u << axis);
        }
    }
    if (homing.phase == PHASE_APPROACH) {
        notice_stalls(moved);
    }
}

static void end_leaving(void) {
    uint32_t closed = home_config_closed(homing.todo);
    if (closed != 0) {
        axis_id_t axis = first_of(closed);
        stepper_home_t home;
        stepper_home_settings(axis, &home);
        cycle_end(CYCLE_NEVER_OPENED, 1u << axis, home.pull_off_mm);
        return;
    }
    homing.todo = 0;
}

// ---- Groups -------------------------------------------------------------------------------------

static void begin_group(void) {
    homing.group = (uint8_t)home_config_next(homing.wanted);
    homing.stalls = 0;
    homing.doubts = 0;
    axis_id_t unsure = home_config_on_either_end(homing.group);
    if (unsure < STEPPER_HOME_AXES) {
        cycle_end(CYCLE_EITHER_END, 1u << unsure, 0.0);
        return;
    }
    machine_lose_position(homing.group);
    uint32_t switches = 0;
    FOR_AXES(axis, homing.group) {
        switches |= home_config_switch_of(axis).bit;
    }
    limits_except(switches);
    enter(PHASE_LEAVE);
}

// The axes of the group stand at their home position. An axis without a switch keeps the
// coordinate that it has.
static void end_group(void) {
    int32_t steps[AXIS_COUNT];
    machine_motor_steps(steps);
    FOR_AXES(axis, homing.group) {
        stepper_home_t home;
        stepper_home_settings(axis, &home);
        axis_to_steps(axis, home.position_mm, &steps[axis]);
    }
    uint8_t known = machine.known_axes | homing.group;
    machine_stand_at(steps);
    machine.known_axes = known;
    machine.position_known = (home_config_all() & ~known) == 0;
    homing.wanted &= (uint8_t)~homing.group;
    homing.group = 0;
    limits_except(0);
}

static void end_move(void) {
    homing.moved = false;
    homing.settled = false;
    if (phases[homing.phase].searches) {
        end_search();
    } else {
        end_leaving();
    }
}

static void begin_move(void) {
    homing.moved = true;
    if (phases[homing.phase].searches) {
        search();
    } else {
        leave();
    }
}

void homing_advance(void) {
    if (!drivers_are_ready(homing_hook_tidy())) {
        return;
    }
    if (homing.moved && !homing.settled) {
        homing.settled = true;
        cycle_settle();
        return;
    }
    if (homing.moved) {
        end_move();
        return; // what is next is found at the next call: that may have been the end
    }
    if (homing.wanted == 0) {
        cycle_end(CYCLE_DONE, 0, 0.0);
        return;
    }
    if (homing.group == 0) {
        begin_group();
    }
    if (homing.group == 0) {
        return; // it was refused
    }
    while (homing.todo == 0 && homing.phase + 1 < PHASES) {
        enter(homing.phase + 1);
    }
    if (homing.todo == 0) {
        end_group();
    } else if (drivers_are_ready(homing_hook_arm(homing.group, phases[homing.phase].towards))) {
        begin_move();
    }
}

// ---- Beginning and end --------------------------------------------------------------------------

err_t stepper_home_check(uint32_t wanted) {
    err_t err = ERR_OK;
    FOR_AXES(axis, wanted) {
        err = err == ERR_OK ? home_config_check(axis) : err;
    }
    if (err == ERR_OK && wanted == 0 && home_config_all() == 0) {
        err = err_raise(ERR_HOME_NO_SWITCH, "No axis has a home switch");
    }
    return err == ERR_OK ? homing_hook_check(wanted != 0 ? wanted : home_config_all()) : err;
}

err_t stepper_home(uint32_t wanted) {
    err_t err = rules_check(RULES_DO_HOME);
    if (err == ERR_OK) {
        err = stepper_home_check(wanted);
    }
    if (err == ERR_OK) {
        err = alarm_acknowledge();
    }
    if (err != ERR_OK) {
        return err;
    }
    homing.wanted = (uint8_t)(wanted != 0 ? wanted : home_config_all());
    homing.group = 0;
    homing.todo = 0;
    homing.moved = false;
    homing.settled = false;
    cycle_begin(STEPPER_CYCLE_HOMING);
    return ERR_OK;
}

void homing_end(bool done) {
    homing_hook_end();
    limits_except(0);
    stepper_raise_event(done ? STEPPER_EVENT_HOMED : STEPPER_EVENT_HOMING_FAILED);
    homing.wanted = 0;
    homing.group = 0;
}

const char *stepper_homing_phase(uint32_t *group) {
    *group = homing.group != 0 ? homing.group : homing.wanted;
    return homing.group != 0 ? phases[homing.phase].doing : "waiting for the queue";
}
