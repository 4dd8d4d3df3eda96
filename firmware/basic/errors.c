// The non-local jump that ends a statement. Context: main loop.
#include "errors.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

static struct {
    jmp_buf *target; // of the innermost errors_try()
} errors;

errors_outcome_t errors_try(void (*work)(void)) {
    jmp_buf here;
    jmp_buf *volatile outer = errors.target;
    volatile int outcome = setjmp(here);
    if (outcome == ERRORS_NONE) {
        errors.target = &here;
        work();
    }
    errors.target = outer;
    return (errors_outcome_t)outcome;
}

void errors_fail(err_t code) {
    err_raise(code, "%s", "");
    errors_fail_raised();
}

void errors_fail_with(err_t code, const char *format, ...) {
    char detail[ERR_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    format_list(detail, sizeof detail, format, args);
    va_end(args);
    err_raise(code, "%s", detail);
    errors_fail_raised();
}

void errors_fail_raised(void) {
    longjmp(*errors.target, ERRORS_FAULT);
}

void errors_break(void) {
    longjmp(*errors.target, ERRORS_BREAK);
}
