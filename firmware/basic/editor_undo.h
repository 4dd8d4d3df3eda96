// What was changed last in the text being edited, to take it back: as much as fits the memory lent
// for it. Context: main loop.
#ifndef BASIC_EDITOR_UNDO_H
#define BASIC_EDITOR_UNDO_H

#include <stdbool.h>
#include <stddef.h>

void editor_undo_start(void *memory, size_t size);

// What follows is taken back by itself, not together with what was done before.
void editor_undo_new_step(void);

// `count` bytes were put in at `place`; `count` bytes at `place` are about to be taken out.
void editor_undo_inserted(size_t place, size_t count);
void editor_undo_erasing(size_t place, size_t count);

// Takes the last step back. *place is where it was. False if there is none. If `*complete` becomes
// false, there was no room in the text to put everything back, and the step is still there.
bool editor_undo_step(size_t *place, bool *complete);

#endif
