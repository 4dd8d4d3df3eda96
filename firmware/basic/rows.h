// The rows of the configuration's tables, numbered through. Context: main loop.
#ifndef BASIC_ROWS_H
#define BASIC_ROWS_H

#include <stdint.h>

#include "basic/basic.h"

#define ROWS_MAX 255u // of each kind

void rows_start(const basic_config_t *config);

// NULL: there is no such row.
const basic_command_t *rows_command(unsigned row);
const basic_function_t *rows_function(unsigned row);
const basic_assignment_t *rows_assignment(unsigned row);

// A row as it stands in code: two bytes, which lead to it without a search.
typedef enum { ROWS_COMMANDS, ROWS_FUNCTIONS, ROWS_ASSIGNMENTS } rows_kind_t;
void rows_emit(rows_kind_t kind, unsigned row);
const basic_command_t *rows_command_at(const uint8_t *code);
const basic_function_t *rows_function_at(const uint8_t *code);
const basic_assignment_t *rows_assignment_at(const uint8_t *code);

#endif
