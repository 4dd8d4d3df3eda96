// What is refused when: one table (rules.def), asked at the beginning of each function that changes
// something. A further face of stepper/, for commands that no function of stepper/ carries out.
// Context: main loop.
#ifndef STEPPER_RULES_H
#define STEPPER_RULES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

// States of the machine that forbid something.
typedef enum {
#define CONDITION(name, error, text) RULES_##name,
#define OPERATION(name, conditions, commands)
#include "stepper/rules.def"
#undef CONDITION
#undef OPERATION
    RULES_CONDITIONS
} rules_condition_t;

// What may be forbidden.
typedef enum {
#define CONDITION(name, error, text)
#define OPERATION(name, conditions, commands) RULES_DO_##name,
#include "stepper/rules.def"
#undef CONDITION
#undef OPERATION
    RULES_OPERATIONS
} rules_operation_t;

// ERR_OK if the machine's state allows it; otherwise the error of the first condition that forbids
// it. Operations that have to be at rest wait for what ends by itself within milliseconds.
err_t rules_check(rules_operation_t operation);

// The table itself, for whoever shows it.
const char *rules_condition_text(rules_condition_t condition);
err_t rules_condition_error(rules_condition_t condition);
const char *rules_operation_text(rules_operation_t operation);
bool rules_forbids(rules_operation_t operation, rules_condition_t condition);

#endif
