// How a job ends, or goes on when an access has failed. Context: main loop.
#ifndef TMC22XX_ENDINGS_H
#define TMC22XX_ENDINGS_H

#include <stdint.h>

#include "tmc22xx/outcome.h"

// All accesses are done: what the job wanted counts.
void endings_succeed(void);

// It cannot succeed: access_fault_t, or one of outcome.h.
void endings_fail(uint8_t fault);

// The access of the phase has failed.
void endings_fail_access(void);

// Nothing is left to be done.
void endings_finish(void);

// How the last job of a statement, and the last one of homing, ended.
const outcome_t *endings_of_statement(void);
const outcome_t *endings_of_arm(void);

#endif
