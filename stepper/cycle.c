// Cycles: what homing and probing have in common. Context: main loop.
#include "stepper/cycle.h"

#include "stepper/alarm.h"
#include "stepper/axis.h"
#include "stepper/governor.h"
#include "stepper/homing.h"
#include "stepper/homing_hook.h"
#include "stepper/limits.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/probing.h"
#include "stepper/step_isr.h"

#define SETTLE_TICKS (HAL_TICK_HZ / 50u) // 20 ms: no switch bounces for longer

static struct {
    stepper_cycle_t kind;
    bool moves;     // its own moves have begun
    bool stopped;   // somebody asked for a stop
    bool was_armed; // when it began

    bool latch_waits; // to be armed
    uint64_t latch_at_us;
    step_isr_latch_t latch;

    stepper_cycle_t last; // how that one ended
    cycle_end_t end;
    uint8_t end_axes;
    float end_mm;
    const char *end_phase;
    bool end_max;       // the switch of the first of `end_axes`
    err_kept_t end_why; // what the hook of homing has told
} cycle;

// What each kind does at a standstill, and when it ends.
typedef struct {
    void (*advance)(void);
    void (*end)(bool done);
} kind_t;

static const kind_t kinds[] = {
    [STEPPER_CYCLE_HOMING] = {homing_advance, homing_end},
    [STEPPER_CYCLE_PROBING] = {probing_advance, probing_end},
};

stepper_cycle_t stepper_cycle(void) {
    return cycle.kind;
}

void cycle_begin(stepper_cycle_t kind) {
    cycle.stopped = false;
    cycle.was_armed = governor_armed();
    cycle.last = STEPPER_CYCLE_NONE;
    machine_arm(STEPPER_IDLE_HOLD);
    cycle.kind = kind;
}

void cycle_forget(void) {
    if (cycle.kind != STEPPER_CYCLE_NONE) {
        cycle_end(CYCLE_STOPPED, 0, 0.0);
    }
    cycle.last = STEPPER_CYCLE_NONE;
}

bool cycle_moves(void) {
    return cycle.moves;
}

void cycle_stop(void) {
    cycle.stopped = true;
}

static void arm_latch(void) {
    cycle.latch_waits = false;
    hal_governor_lock();
    step_isr_latch_arm(&cycle.latch);
    hal_governor_unlock();
}

static void disarm_latch(void) {
    cycle.latch_waits = false;
    hal_governor_lock();
    step_isr_latch_disarm();
    hal_governor_unlock();
}

void cycle_end(cycle_end_t why, uint32_t who, double mm) {
    uint32_t group;
    const char *phase = stepper_homing_phase(&group);
    cycle.last = cycle.kind;
    cycle.end = why;
    cycle.end_axes = (uint8_t)(who != 0 ? who : group);
    cycle.end_mm = (float)mm;
    cycle.end_phase = phase;
    if (why == CYCLE_DRIVER) {
        err_keep(&cycle.end_why);
    }
    home_switch_t found = {0};
    if (cycle.end_axes != 0) {
        home_config_switch((axis_id_t)__builtin_ctz(cycle.end_axes), &found);
    }
    cycle.end_max = found.max;
    disarm_latch();
    kinds[cycle.kind].end(why == CYCLE_DONE);
    cycle.kind = STEPPER_CYCLE_NONE;
    if (cycle.moves) {
        cycle.moves = false;
        machine_pass_override_on();
    }
    if (!governor_armed()) {
        return;
    }
    if (cycle.was_armed) {
        machine_arm(machine.idle);
        return;
    }
    hal_governor_lock();
    governor_disarm();
    hal_governor_unlock();
}

void cycle_follow(void) {
    if (cycle.kind == STEPPER_CYCLE_NONE) {
        return;
    }
    if (!governor_armed()) {
        cycle_end(cycle.stopped ? CYCLE_STOPPED : CYCLE_TRIPPED, 0, 0.0);
    } else if (cycle.stopped && !governor_working() && !machine_stopping()) {
        cycle_end(CYCLE_STOPPED, 0, 0.0);
    }
}

void stepper_background(void) {
    if (cycle.kind == STEPPER_CYCLE_NONE) {
        homing_hook_tidy();
        return;
    }
    if (cycle.latch_waits && hal_time_us() >= cycle.latch_at_us) {
        arm_latch();
    }
    machine_follow_stops();
    if (cycle.kind != STEPPER_CYCLE_NONE && !governor_working() && !machine_stopping()) {
        if (!cycle.moves) {
            cycle.moves = true;
            machine_pass_override_on();
        }
        kinds[cycle.kind].advance();
    }
}

// ---- Moves --------------------------------------------------------------------------------------

void cycle_move(const int32_t target[AXIS_COUNT], double feed, const cycle_until_t *until) {
    stepper_move_t move = {
        .feed = feed,
        .corner = STEPPER_CORNER_STOP,
    };
    for (axis_id_t axis = 0; axis < AXIS_COUNT; axis++) {
        move.target[axis] = axis_from_steps(axis, target[axis]);
    }
    if (until != NULL) {
        cycle.latch = (step_isr_latch_t){
            .pins = until->pins,
            .levels = until->levels,
            .halts = until->halts,
            .samples = limits_latch_samples(),
        };
        cycle.latch_at_us = hal_time_us() + until->after_us;
        cycle.latch_waits = until->after_us > 0;
        if (!cycle.latch_waits) {
            arm_latch();
        }
    }
    moves_push_line(&move, target);
    hal_governor_request();
}

uint32_t cycle_moved(int32_t steps[AXIS_COUNT]) {
    uint32_t pins;
    hal_governor_lock();
    bool latched = step_isr_latched(steps, &pins);
    hal_governor_unlock();
    disarm_latch();
    return latched ? pins : 0;
}

void cycle_settle(void) {
    moves_push_dwell(SETTLE_TICKS, false);
    hal_governor_request();
}

// ---- The result ---------------------------------------------------------------------------------

static void letters_of(uint32_t mask, char text[STEPPER_HOME_AXES + 1]) {
    unsigned length = 0;
    for (axis_id_t axis = 0; axis < STEPPER_HOME_AXES; axis++) {
        if ((mask >> axis) & 1) {
            text[length++] = STEPPER_AXIS_LETTERS[axis];
        }
    }
    text[length] = '\0';
}

static const char *const probing_texts[] = {
    [CYCLE_STOPPED] = "stopped",
    [CYCLE_NO_CONTACT] = "failed: no contact before the target",
    [CYCLE_CONTACT_KEPT] = "failed: contact not lost before the target",
    [CYCLE_CONTACT_BEFORE] = "failed: the probe has contact already",
    [CYCLE_NO_CONTACT_BEFORE] = "failed: the probe has no contact to lose",
};

// What has stopped the machine at once.
static const char *trip_name(char names[ALARM_NAMES_SIZE]) {
    return machine.alarm ? alarm_names(names) : "emergency stop";
}

static err_t raise_homing(void) {
    char letters[STEPPER_HOME_AXES + 1];
    char names[ALARM_NAMES_SIZE];
    letters_of(cycle.end_axes, letters);
    switch (cycle.end) {
    case CYCLE_STOPPED:
        return err_raise(ERR_HOMING_FAILED, "%s stopped while %s", letters, cycle.end_phase);
    case CYCLE_TRIPPED:
        return err_raise(ERR_HOMING_FAILED, "%s failed: %s while %s", letters, trip_name(names),
                         cycle.end_phase);
    case CYCLE_TOO_FAR:
        return err_raise(ERR_HOMING_FAILED,
                         "%s failed: its position is too far from zero for more travel", letters);
    case CYCLE_DRIVER:
        return err_raise(ERR_HOMING_FAILED, "%s failed: %s", letters, cycle.end_why.text);
    case CYCLE_EITHER_END:
        return err_raise(ERR_HOMING_FAILED,
                         "%s failed: it stands on the switch of either end - jog off it", letters);
    default:
        return err_raise(ERR_HOMING_FAILED, "%s failed: the switch %s_%s %s %.4g mm while %s",
                         letters, letters, cycle.end_max ? "MAX" : "MIN",
                         cycle.end == CYCLE_NEVER_CLOSED ? "never closed within"
                                                         : "did not open within",
                         (double)cycle.end_mm, cycle.end_phase);
    }
}

static err_t raise_probing(void) {
    char names[ALARM_NAMES_SIZE];
    if (cycle.end == CYCLE_TRIPPED) {
        return err_raise(ERR_PROBING_FAILED, "failed: %s", trip_name(names));
    }
    return err_raise(ERR_PROBING_FAILED, "%s", probing_texts[cycle.end]);
}

err_t stepper_cycle_result(void) {
    if (cycle.last == STEPPER_CYCLE_NONE || cycle.end == CYCLE_DONE) {
        return ERR_OK;
    }
    return cycle.last == STEPPER_CYCLE_HOMING ? raise_homing() : raise_probing();
}
