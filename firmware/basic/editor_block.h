// The marked part of the text and the clipboard. Context: main loop.
#ifndef BASIC_EDITOR_BLOCK_H
#define BASIC_EDITOR_BLOCK_H

void editor_block_mark(void); // begins to mark at the cursor
void editor_block_copy(void);
void editor_block_cut(void);
void editor_block_delete(void);
void editor_block_paste(void);

// Moves the marked lines a tab stop to the right; those, or the cursor's line, to the left.
void editor_block_indent(void);
void editor_block_unindent(void);

#endif
