// Which of several commands with one name is meant. Context: main loop, while compiling.
#ifndef BASIC_ARGS_SELECT_H
#define BASIC_ARGS_SELECT_H

// Of the commands with the name of row `row`, the one that the arguments at `start` select. The
// token at hand is any other afterwards. Errors: the argument that selects is missing, or none of
// the rows has it.
int args_select_row(int row, const char *start);

#endif
