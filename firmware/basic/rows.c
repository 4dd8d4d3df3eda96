// Finds the configuration's rows. A number counts through all tables, which suits the compiler;
// code names table and row, which suits the interpreter. Context: main loop.
#include "rows.h"

#include "emit.h"

static const basic_config_t *config;

void rows_start(const basic_config_t *new_config) {
    config = new_config;
}

static size_t count_of(const basic_rows_t *table, rows_kind_t kind) {
    return kind == ROWS_COMMANDS    ? table->command_count
           : kind == ROWS_FUNCTIONS ? table->function_count
                                    : table->assignment_count;
}

// The table that has the row, and the row's number in it; NULL: none.
static const basic_rows_t *find(rows_kind_t kind, unsigned *row, unsigned *number) {
    for (*number = 0; *number < config->table_count; (*number)++) {
        const basic_rows_t *table = config->tables[*number];
        size_t count = count_of(table, kind);
        if (*row < count) {
            return table;
        }
        *row -= (unsigned)count;
    }
    return NULL;
}

const basic_command_t *rows_command(unsigned row) {
    unsigned number;
    const basic_rows_t *table = find(ROWS_COMMANDS, &row, &number);
    return table != NULL ? &table->commands[row] : NULL;
}

const basic_function_t *rows_function(unsigned row) {
    unsigned number;
    const basic_rows_t *table = find(ROWS_FUNCTIONS, &row, &number);
    return table != NULL ? &table->functions[row] : NULL;
}

const basic_assignment_t *rows_assignment(unsigned row) {
    unsigned number;
    const basic_rows_t *table = find(ROWS_ASSIGNMENTS, &row, &number);
    return table != NULL ? &table->assignments[row] : NULL;
}

void rows_emit(rows_kind_t kind, unsigned row) {
    unsigned number;
    find(kind, &row, &number);
    emit_byte(number);
    emit_byte(row);
}

const basic_command_t *rows_command_at(const uint8_t *code) {
    return &config->tables[code[0]]->commands[code[1]];
}

const basic_function_t *rows_function_at(const uint8_t *code) {
    return &config->tables[code[0]]->functions[code[1]];
}

const basic_assignment_t *rows_assignment_at(const uint8_t *code) {
    return &config->tables[code[0]]->assignments[code[1]];
}
