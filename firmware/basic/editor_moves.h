// Where the editor's cursor can go. Context: main loop.
#ifndef BASIC_EDITOR_MOVES_H
#define BASIC_EDITOR_MOVES_H

#include <stdbool.h>

void editor_moves_left(void);
void editor_moves_right(void);
void editor_moves_up(void);
void editor_moves_down(void);
void editor_moves_page_up(void);
void editor_moves_page_down(void);
void editor_moves_text_start(void);
void editor_moves_text_end(void);
void editor_moves_word_left(void);
void editor_moves_word_right(void);

// The start and the end of the line; `again`, and already there: of the text.
void editor_moves_home(bool again);
void editor_moves_end(bool again);

#endif
