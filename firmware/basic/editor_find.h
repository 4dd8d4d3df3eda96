// Find and replace in the editor. Context: main loop.
#ifndef BASIC_EDITOR_FIND_H
#define BASIC_EDITOR_FIND_H

// Asks what to look for, and goes to it; the same again, without asking.
void editor_find(void);
void editor_find_next(void);

// Asks what to replace by what, and at each place whether to.
void editor_find_replace(void);

#endif
