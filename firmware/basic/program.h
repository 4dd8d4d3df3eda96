// The program: its text, in flash, and its code. Context: main loop.
#ifndef BASIC_PROGRAM_H
#define BASIC_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"

// Takes the program that is stored. Error: it is damaged; or what program_compile() says.
err_t program_start(void);

// Stores `text` (which may lie anywhere, the free part of the arena included) and compiles it. All
// variables are gone. Errors: it could not be stored, then nothing has changed, variables included;
// or what program_compile() says.
err_t program_set_text(const char *text, size_t length);

// The same in two steps: after the first the arena is as it was, for whoever has the text there.
err_t program_store_text(const char *text, size_t length);
err_t program_compile_stored(void); // if there is something new

// Gives up its code and all variables, for whoever needs nearly all of the arena for a while;
// program_compile_stored() brings the code back.
void program_release(void);

// As program_set_text(), with what a file holds, which need not fit the memory.
err_t program_load(const char *path);

// Makes a text the program without storing it; its lines end with \n, and it has to stay where it
// is.
err_t program_use_text(const char *text, size_t length);

// Compiles it afresh, which forgets all variables and reserves `argument` (MM.CMDLINE$) for its
// run. Error: the memory is too small for its code; nothing can be run then, the text stays.
err_t program_compile(const char *argument, size_t length);

// NULL if it is empty or did not compile.
const uint8_t *program_code(void);

// Lines end with \n. In flash: it must not be handed to what writes the flash without a copy.
const char *program_text(void);
size_t program_length(void);

// Bytes of its code.
size_t program_code_size(void);

// What RUN was given for the program, MM.CMDLINE$.
const char *program_argument(size_t *length);

// Line `number` (from 1) without its end; NULL if there is none.
const char *program_line(unsigned number, size_t *length);

#endif
