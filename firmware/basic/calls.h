// Calls of SUBs, FUNCTIONs and GOSUBs. Context: main loop.
#ifndef BASIC_CALLS_H
#define BASIC_CALLS_H

#include <stdbool.h>
#include <stdint.h>

#include "symbols.h"
#include "vm.h"

// Enters a routine with `count` arguments on the stack, above the place for its value; vm.pc is
// where to come back to. Errors: argument list, wrong type, nested too deep.
void calls_enter(const symbols_routine_t *routine, unsigned count);

// True if a SUB without parameters can be entered and still call others.
bool calls_have_room(const symbols_routine_t *routine);

// Leaves the routine; a FUNCTION's value is on the stack then.
void calls_leave(void);

// Marks of frames that are no routine's: text that runs by EXECUTE or EVAL (indirect.c).
extern const symbols_routine_t calls_execute, calls_eval;

// The next frame, for one who fills it and counts vm.depth up. Error: nested too deep.
vm_frame_t *calls_new_frame(void);

// Copies strings that wait on the stack, where code that is about to run could change them.
void calls_save_texts(value_t *from, const value_t *end);

// The routine that runs; NULL: none.
const symbols_routine_t *calls_routine(void);

// GOSUB and RETURN. calls_return() gives the place to go on at.
void calls_gosub(const uint8_t *return_pc);
const uint8_t *calls_return(void);

#endif
