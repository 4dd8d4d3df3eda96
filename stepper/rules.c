// What is refused when. Context: main loop.
#include "stepper/rules.h"

#include "stepper/alarm.h"
#include "stepper/governor.h"
#include "stepper/jog.h"
#include "stepper/machine.h"
#include "stepper/moves.h"
#include "stepper/planner.h"
#include "stepper/stepper_homing.h"

// The conditions as bits.
enum {
#define CONDITION(name, error, text) WHEN_##name = 1 << RULES_##name,
#define OPERATION(name, conditions, commands)
#include "stepper/rules.def"
#undef CONDITION
#undef OPERATION
};

static const struct {
    err_t error;
    const char *text;
} conditions[RULES_CONDITIONS] = {
#define CONDITION(name, error, text) [RULES_##name] = {ERR_##error, text},
#define OPERATION(name, conditions, commands)
#include "stepper/rules.def"
#undef CONDITION
#undef OPERATION
};

static const struct {
    uint32_t forbidden;
    const char *text;
} operations[RULES_OPERATIONS] = {
#define CONDITION(name, error, text)
#define OPERATION(name, conditions, commands) [RULES_DO_##name] = {conditions, commands},
#include "stepper/rules.def"
#undef CONDITION
#undef OPERATION
};

static uint32_t bit(bool holds, rules_condition_t condition) {
    return holds ? 1u << condition : 0;
}

// Conditions that lines and arcs do not ask for, whose check has to be quick.
#define SELDOM                                                                                     \
    (WHEN_ESTOP | WHEN_MOVING | WHEN_JOB | WHEN_BUSY | WHEN_ARMED | WHEN_NOT_ARMED | WHEN_WAITING)

static uint32_t find_seldom(void) {
    bool working = governor_working();
    bool queued = ring_used(&blocks.ring) > 0;
    bool armed = governor_armed();
    return bit(machine_estop_asserted(), RULES_ESTOP) | bit(working, RULES_MOVING) |
           bit(queued && !jog_active(), RULES_JOB) | bit(working || queued, RULES_BUSY) |
           bit(armed, RULES_ARMED) | bit(!armed, RULES_NOT_ARMED) |
           bit(queued && !armed, RULES_WAITING);
}

// Those of the asked conditions that hold now.
static uint32_t find_state(uint32_t asked) {
    if (!machine.initialized) {
        return asked & WHEN_NOT_INITIALIZED;
    }
    uint32_t state = WHEN_INITIALIZED | bit(machine.alarm, RULES_ALARM) |
                     bit(stepper_cycle() != STEPPER_CYCLE_NONE, RULES_CYCLE) |
                     bit(machine_stopping(), RULES_STOPPING) | bit(jog_active(), RULES_JOGGING) |
                     bit(machine.limit_active, RULES_LIMIT) |
                     bit(!machine.position_known, RULES_POSITION) |
                     bit(moves_free() == 0, RULES_FULL);
    if (asked & SELDOM) {
        state |= find_seldom();
    }
    return asked & state;
}

static err_t refuse(rules_condition_t condition) {
    char names[ALARM_NAMES_SIZE];
    const char *detail = "";
    if (condition == RULES_CYCLE) {
        detail = stepper_cycle() == STEPPER_CYCLE_PROBING ? "Probing" : "Homing";
    } else if (condition == RULES_ALARM) {
        detail = alarm_names(names);
    } else if (condition == RULES_LIMIT) {
        detail = stepper_switch_names(names, stepper_overridden());
    }
    return err_raise(conditions[condition].error, "%s", detail);
}

err_t rules_check(rules_operation_t operation) {
    uint32_t forbidden = operations[operation].forbidden;
    if (forbidden & (WHEN_BUSY | WHEN_MOVING)) {
        machine_await_end();
    }
    machine_follow_stops();
    uint32_t found = find_state(forbidden);
    if (found == 0) {
        return ERR_OK;
    }
    unsigned first = 0;
    while (((found >> first) & 1) == 0) {
        first++;
    }
    return refuse((rules_condition_t)first);
}

const char *rules_condition_text(rules_condition_t condition) {
    return conditions[condition].text;
}

err_t rules_condition_error(rules_condition_t condition) {
    return conditions[condition].error;
}

const char *rules_operation_text(rules_operation_t operation) {
    return operations[operation].text;
}

bool rules_forbids(rules_operation_t operation, rules_condition_t condition) {
    return ((operations[operation].forbidden >> condition) & 1) != 0;
}
