// VAR SAVE and VAR RESTORE: variables by name, with type and shape, in a file that is replaced as a
// whole. All end the statement by an error unless they succeed. Context: main loop.
#ifndef BASIC_SAVED_VARIABLES_H
#define BASIC_SAVED_VARIABLES_H

#include "value.h"

// Adds these variables of the program (their handles) to what is saved, or saves their new values.
// Errors: one of them does not exist or is a constant, what is there is damaged, and those of
// writing files.
void saved_variables_save(const value_t *handles, unsigned count);

// Gives all that is saved back to the variables of these names, which are made if they do not
// exist. Errors: damaged, and a variable that is of another type or shape.
void saved_variables_restore(void);

// Forgets what is saved.
void saved_variables_clear(void);

#endif
