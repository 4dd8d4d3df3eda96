// How a statement ends early: one non-local jump, from wherever the fault is seen to whoever runs
// statements. It never leaves firmware/basic. Context: main loop.
#ifndef BASIC_ERRORS_H
#define BASIC_ERRORS_H

#include <stdbool.h>

#include "base/base.h"

typedef enum { ERRORS_NONE, ERRORS_FAULT, ERRORS_BREAK } errors_outcome_t;

// Calls work(); says how it ended. Calls may nest.
errors_outcome_t errors_try(void (*work)(void));

// Raises `code`, whose text takes no detail, and ends the current errors_try().
_Noreturn void errors_fail(err_t code);

// The same with the detail the text asks for.
_Noreturn void errors_fail_with(err_t code, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Ends the current errors_try() with the error that err_message() holds.
_Noreturn void errors_fail_raised(void);

// The user pressed Ctrl-C.
_Noreturn void errors_break(void);

#endif
