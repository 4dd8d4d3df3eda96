// The statements of the language: one row each. Context: main loop, while compiling.
#ifndef BASIC_STATEMENTS_H
#define BASIC_STATEMENTS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    const char *name;
    void (*compile)(void); // the word itself is already gone past
    const char *usage;     // for HELP; NULL: part of another statement
    const char *help;
} statements_row_t;

extern const statements_row_t statements_table[];
extern const size_t statements_count;

// True for a word that opens a statement but is meant as a value here: at the prompt, TIMER and
// MATH(...).
bool statements_is_value(void);

// Assignment, call of a SUB, or (at the prompt) an expression; for a word that opens no statement.
// False: it is none of these.
bool statements_compile_other(void);

// The options that are kept over power-off, for OPTION. False: it is none of them.
bool statements_option_kept(void);

// Closes a SUB or FUNCTION that has no end; a call of it raises the error.
void statements_abandon_routine(void);

// statements_flow.c, statements_routine.c, statements_data.c, statements_io.c,
// statements_channels.c, statements_files.c, statements_system.c, statements_events.c,
// statements_machine.c
#define STATEMENTS_DECLARE(name) void statements_##name(void);
STATEMENTS_DECLARE(if)
STATEMENTS_DECLARE(elseif)
STATEMENTS_DECLARE(else)
STATEMENTS_DECLARE(endif)
STATEMENTS_DECLARE(for)
STATEMENTS_DECLARE(next)
STATEMENTS_DECLARE(do)
STATEMENTS_DECLARE(while)
STATEMENTS_DECLARE(loop)
STATEMENTS_DECLARE(wend)
STATEMENTS_DECLARE(exit)
STATEMENTS_DECLARE(continue)
STATEMENTS_DECLARE(select)
STATEMENTS_DECLARE(case)
STATEMENTS_DECLARE(call)
STATEMENTS_DECLARE(execute)
STATEMENTS_DECLARE(goto)
STATEMENTS_DECLARE(gosub)
STATEMENTS_DECLARE(return)
STATEMENTS_DECLARE(on)
STATEMENTS_DECLARE(end)
STATEMENTS_DECLARE(end_routine)
STATEMENTS_DECLARE(on_error)
STATEMENTS_DECLARE(on_key)
STATEMENTS_DECLARE(cpu)
STATEMENTS_DECLARE(trace)
STATEMENTS_DECLARE(update)
STATEMENTS_DECLARE(watchdog)
STATEMENTS_DECLARE(settick)
STATEMENTS_DECLARE(sub)
STATEMENTS_DECLARE(function)
STATEMENTS_DECLARE(local)
STATEMENTS_DECLARE(static)
STATEMENTS_DECLARE(dim)
STATEMENTS_DECLARE(redim)
STATEMENTS_DECLARE(erase)
STATEMENTS_DECLARE(clear)
STATEMENTS_DECLARE(cls)
STATEMENTS_DECLARE(const)
STATEMENTS_DECLARE(let)
STATEMENTS_DECLARE(inc)
STATEMENTS_DECLARE(cat)
STATEMENTS_DECLARE(sort)
STATEMENTS_DECLARE(math)
STATEMENTS_DECLARE(data)
STATEMENTS_DECLARE(read)
STATEMENTS_DECLARE(restore)
STATEMENTS_DECLARE(rem)
STATEMENTS_DECLARE(print)
STATEMENTS_DECLARE(input)
STATEMENTS_DECLARE(line)
STATEMENTS_DECLARE(open)
STATEMENTS_DECLARE(close)
STATEMENTS_DECLARE(seek)
STATEMENTS_DECLARE(flush)
STATEMENTS_DECLARE(chdir)
STATEMENTS_DECLARE(copy)
STATEMENTS_DECLARE(files)
STATEMENTS_DECLARE(kill)
STATEMENTS_DECLARE(mkdir)
STATEMENTS_DECLARE(rename)
STATEMENTS_DECLARE(rmdir)
STATEMENTS_DECLARE(xmodem)
STATEMENTS_DECLARE(print_channel)
STATEMENTS_DECLARE(input_channel)
STATEMENTS_DECLARE(line_input_channel)
STATEMENTS_DECLARE(pause)
STATEMENTS_DECLARE(timer)
STATEMENTS_DECLARE(randomize)
STATEMENTS_DECLARE(error)
STATEMENTS_DECLARE(option)
STATEMENTS_DECLARE(run)
STATEMENTS_DECLARE(new)
STATEMENTS_DECLARE(load)
STATEMENTS_DECLARE(save)
STATEMENTS_DECLARE(var)
STATEMENTS_DECLARE(list)
STATEMENTS_DECLARE(autosave)
STATEMENTS_DECLARE(edit)
STATEMENTS_DECLARE(help)
STATEMENTS_DECLARE(memory)
#undef STATEMENTS_DECLARE

#endif
