// What a statement leaves for the prompt to do once nothing runs any more (vm.request), with the
// file and the text it is to be done with. Context: main loop.
#ifndef BASIC_REQUESTS_H
#define BASIC_REQUESTS_H

#include <stddef.h>

#include "value.h"
#include "vm.h"

// Leaves the loop after this statement. Errors: `file`, or both together, are too long.
void requests_make(vm_request_t request, const value_t *file, const value_t *argument);

// Forgets it.
void requests_clear(void);

// Of the request made last; "" if there is none.
const char *requests_file(void);
const char *requests_argument(size_t *length);

// The name of a program's file, zero-terminated: with ".bas" if `name` has no extension.
// Errors: empty, too long.
void requests_program_name(const value_t *name, char *file, size_t size);

#endif
