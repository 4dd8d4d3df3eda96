// What the keys do in the editor. Context: main loop.
#ifndef BASIC_EDITOR_COMMANDS_H
#define BASIC_EDITOR_COMMANDS_H

#include <stdbool.h>

typedef enum {
    EDITOR_COMMANDS_GO_ON,
    EDITOR_COMMANDS_LEAVE,
    EDITOR_COMMANDS_SAVE,
    EDITOR_COMMANDS_RUN, // save and run
} editor_commands_end_t;

// `on_break`: what Ctrl-C does at the prompt.
void editor_commands_start(void (*on_break)(void));

editor_commands_end_t editor_commands_do(int key);

// True if the text can be kept; else it says why not and goes to the place.
bool editor_commands_check(void);

#endif
