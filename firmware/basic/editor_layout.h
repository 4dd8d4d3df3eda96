// How the editor shares the free part of the arena out, and the size of the screen. Context: main
// loop.
#ifndef BASIC_EDITOR_LAYOUT_H
#define BASIC_EDITOR_LAYOUT_H

#include <stdbool.h>

// Asks the terminal for the size of its screen; it answers with the key KEYS_SIZE, or not at all.
void editor_layout_ask_size(void);

// Gives memory to screen, text and undo, for the size that the terminal told last (`told`) or
// OPTION DISPLAY says. False: there is too little.
bool editor_layout_start(bool told);

// Takes the size that the terminal has told, as far as there is memory, and draws all anew.
void editor_layout_resize(void);

// Draws all anew and asks for the size once more.
void editor_layout_refresh(void);

#endif
