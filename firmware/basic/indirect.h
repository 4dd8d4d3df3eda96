// What a program names or writes only while it runs: CALL, EVAL and EXECUTE. Context: main loop.
#ifndef BASIC_INDIRECT_H
#define BASIC_INDIRECT_H

typedef enum {
    INDIRECT_SUB,         // a name, arguments above it
    INDIRECT_FUNCTION,    // the same; the value comes in the place of the name
    INDIRECT_EVAL,        // a text, whose value comes in its place
    INDIRECT_EVAL_END,    // end of what EVAL compiled
    INDIRECT_EXECUTE,     // a text of statements
    INDIRECT_EXECUTE_END, // end of what EXECUTE compiled
} indirect_kind_t;

// Carries out OP_INDIRECT; what it works on is on the stack. vm.pc and vm.sp come back changed.
// Errors: no such routine, those of compiling, nested too deep, not enough memory.
void indirect_run(indirect_kind_t kind, unsigned count);

// After an error that is passed over: leaves the EVALs of the statement that failed.
void indirect_unwind(void);

#endif
