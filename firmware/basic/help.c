// HELP, made of the tables of statements, functions and the configuration's rows. Context: main
// loop.
#include "help.h"

#include <string.h>

#include "args.h"
#include "console.h"
#include "errors.h"
#include "functions.h"
#include "lexer.h"
#include "number_text.h"
#include "rows.h"
#include "statements.h"

static void print_line(const char *text) {
    console_print(text);
    console_new_line();
}

// Names side by side, wrapped.
static void print_word(const char *word) {
    if (console_column() + strlen(word) + 2 > console_columns() - 2) {
        console_new_line();
    }
    console_print(console_column() == 0 ? "  " : ", ");
    console_print(word);
}

static void print_command_names(void) {
    const basic_command_t *row;
    for (unsigned i = 0; (row = rows_command(i)) != NULL; i++) {
        if (i == 0 || strcmp(row->name, rows_command(i - 1)->name) != 0) {
            print_word(row->name);
        }
    }
    console_fresh_line();
}

static void print_statement_names(void) {
    for (size_t i = 0; i < statements_count; i++) {
        if (statements_table[i].usage != NULL) {
            print_word(statements_table[i].name);
        }
    }
    console_fresh_line();
}

// Rows of one name may be in several tables.
static bool is_first_of_name(unsigned index) {
    const char *name = rows_function(index)->name;
    unsigned first = 0;
    while (strcmp(rows_function(first)->name, name) != 0) {
        first++;
    }
    return first == index;
}

static void print_function_names(void) {
    for (unsigned i = 0; rows_function(i) != NULL; i++) {
        if (is_first_of_name(i)) {
            print_word(rows_function(i)->name);
        }
    }
    for (size_t i = 0; i < functions_count; i++) {
        if (strchr(functions_table[i].name, '(') == NULL) { // a family stands for its members
            print_word(functions_table[i].name);
        }
    }
    console_fresh_line();
}

static void print_overview(void) {
    print_line("Commands of the machine:");
    print_command_names();
    print_line("Statements:");
    print_statement_names();
    print_line("Functions:");
    print_function_names();
    print_line("HELP name tells more, for instance HELP PRINT.");
}

void help_print_words(bool commands) {
    if (commands) {
        print_command_names();
        print_statement_names();
    } else {
        print_function_names();
    }
}

static bool is_optional(const basic_arg_spec_t *spec) {
    return (spec->flags & (BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT)) != 0;
}

// What is written in an argument's place: its name, or the words that tell rows of one name apart.
static void print_place(const basic_arg_spec_t *spec) {
    if (spec->flags & BASIC_ARG_SELECTS) {
        console_print(spec->choices);
    } else {
        console_print(spec->name);
    }
}

// `before` stands before the first place. A repeated argument and those behind it share a bracket.
static void print_usage(const basic_arg_spec_t *args, size_t count, const char *before) {
    const char *end = "";
    for (size_t i = 0; i < count; i++) {
        bool repeats = (args[i].flags & BASIC_ARG_REPEAT) != 0;
        bool bracket = repeats || (*end == '\0' && is_optional(&args[i]));
        console_print(i == 0 ? before : bracket ? " " : "");
        console_print(bracket ? "[" : "");
        console_print(i > 0 ? ", " : "");
        print_place(&args[i]);
        console_print(bracket && !repeats ? "]" : "");
        end = repeats ? "] ..." : end;
    }
    console_print(end);
}

static const char *kind_text(const basic_arg_spec_t *spec) {
    switch (spec->kind) {
    case BASIC_ARG_TEXT:
        return "a string";
    case BASIC_ARG_WORD:
        return (spec->flags & BASIC_ARG_OR_NUMBER) != 0 ? "a word, a string or a number"
                                                        : "a word or a string";
    case BASIC_ARG_PIN:
        return "a pin: GP0 to GP28, or a number";
    case BASIC_ARG_ROUTINE:
        return "the name of a SUB without parameters, or 0";
    case BASIC_ARG_DATA:
        return "numbers, one string or one array()";
    case BASIC_ARG_STORE:
        return "a variable or an array()";
    case BASIC_ARG_RAW:
        return "the rest of the line";
    default:
        return "a number";
    }
}

static void print_argument(const basic_arg_spec_t *spec) {
    char text[256];
    char range[136];
    bool limited = spec->kind <= BASIC_ARG_INTEGER && (spec->min != 0.0 || spec->max != 0.0);
    if (limited || spec->choices != NULL) {
        args_describe_range(spec, range, sizeof range);
    } else {
        format_text(range, sizeof range, "%s", kind_text(spec));
    }
    char fallback[NUMBER_TEXT_SIZE] = "";
    if (spec->flags & BASIC_ARG_DEFAULT) {
        args_format_limit(fallback, spec->fallback);
    }
    format_text(text, sizeof text, "  %-16s %s%s%s%s%s%s%s%s", spec->name, range,
                spec->unit != NULL ? " " : "", spec->unit != NULL ? spec->unit : "",
                *fallback != '\0' ? ", default " : "", fallback,
                is_optional(spec) && *fallback == '\0' ? ", optional" : "",
                spec->help != NULL ? ": " : "", spec->help != NULL ? spec->help : "");
    print_line(text);
}

// An argument that is there already, such as the first one again of a group that repeats.
static bool is_known(const basic_arg_spec_t *args, size_t i) {
    for (size_t before = 0; before < i; before++) {
        if (strcmp(args[before].name, args[i].name) == 0 && args[before].help == args[i].help) {
            return true;
        }
    }
    return false;
}

static void print_arguments(const basic_arg_spec_t *args, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (!is_known(args, i)) {
            print_argument(&args[i]);
        }
    }
}

static void print_help_sentence(const char *help) {
    if (help != NULL) {
        console_print("  ");
        print_line(help);
    }
}

static void print_command(const basic_command_t *row) {
    console_print(row->name);
    print_usage(row->args, row->arg_count, " ");
    console_new_line();
    print_help_sentence(row->help);
    print_arguments(row->args, row->arg_count);
}

static void print_function(const basic_function_t *row) {
    bool parentheses = row->keyword != NULL || row->arg_count > 0;
    console_print(row->name);
    console_print(parentheses ? "(" : "");
    console_print(row->keyword != NULL ? row->keyword : "");
    print_usage(row->args, row->arg_count, row->keyword != NULL ? " " : "");
    print_line(parentheses ? ")" : "");
    print_help_sentence(row->help);
    print_arguments(row->args, row->arg_count);
}

static void print_assignment(const basic_assignment_t *row) {
    console_print(row->name);
    console_print("(");
    print_usage(row->args + 1, row->arg_count - 1, "");
    console_print(") = ");
    print_line(row->args[0].name);
    print_help_sentence(row->help);
    print_arguments(row->args, row->arg_count);
}

// True if `name` starts with the topic and a word ends there.
static bool starts_with(const char *name, const char *topic, size_t length) {
    return letters_same(name, topic, length) && // not beyond the end of `name`, which differs
           (name[length] == ' ' || name[length] == '\0');
}

// Rows whose name is the topic are explained; rows it only starts are listed.
static bool print_commands(const char *topic, size_t length) {
    bool found = false;
    bool listed = false;
    const basic_command_t *row;
    for (unsigned i = 0; (row = rows_command(i)) != NULL; i++) {
        if (!starts_with(row->name, topic, length)) {
            continue;
        }
        if (strlen(row->name) == length) {
            print_command(row);
        } else {
            print_word(row->name);
            listed = true;
        }
        found = true;
    }
    if (listed) {
        console_fresh_line();
    }
    return found;
}

static bool print_language(const char *topic, size_t length) {
    bool found = false;
    for (size_t i = 0; i < statements_count; i++) {
        const statements_row_t *row = &statements_table[i];
        if (row->usage != NULL && lexer_same(topic, length, row->name)) {
            print_line(row->usage);
            print_help_sentence(row->help);
            found = true;
        }
    }
    for (size_t i = 0; i < functions_count; i++) {
        const functions_row_t *row = &functions_table[i];
        if (row->help != NULL && lexer_same(topic, length, row->name)) {
            print_line(row->help);
            found = true;
        }
    }
    const basic_function_t *function;
    for (unsigned i = 0; (function = rows_function(i)) != NULL; i++) {
        if (lexer_same(topic, length, function->name)) {
            print_function(function);
            found = true;
        }
    }
    const basic_assignment_t *assignment;
    for (unsigned i = 0; (assignment = rows_assignment(i)) != NULL; i++) {
        if (lexer_same(topic, length, assignment->name)) {
            print_assignment(assignment);
            found = true;
        }
    }
    return found;
}

static bool is_in_word(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '$';
}

// True if the topic stands in the text as words of their own, in capitals as keywords do.
static bool mentions(const char *text, const char *topic, size_t length) {
    for (const char *p = text; *p != '\0'; p++) {
        size_t same = 0;
        while (same < length && p[same] != '\0' && p[same] == letters_upper(topic[same])) {
            same++;
        }
        if (same == length && (p == text || !is_in_word(p[-1])) && !is_in_word(p[same])) {
            return true;
        }
    }
    return false;
}

// The statements that a word such as NEXT or RETURN is a part of.
static bool print_mentions(const char *topic, size_t length) {
    bool found = false;
    for (size_t i = 0; length > 1 && i < statements_count; i++) {
        const statements_row_t *row = &statements_table[i];
        if (row->usage != NULL &&
            (mentions(row->usage, topic, length) || mentions(row->help, topic, length))) {
            print_line(row->usage);
            print_help_sentence(row->help);
            found = true;
        }
    }
    return found;
}

// The first of several words, such as ON of ON KEY.
static size_t first_word_length(const char *topic, size_t length) {
    const char *blank = memchr(topic, ' ', length);
    return blank != NULL ? (size_t)(blank - topic) : length;
}

void help_print(const char *topic, size_t length) {
    if (length == 0) {
        print_overview();
        return;
    }
    bool command = print_commands(topic, length);
    if (!print_language(topic, length) && !command && !print_mentions(topic, length) &&
        !print_language(topic, first_word_length(topic, length))) {
        errors_fail_with(ERR_ARGUMENT, "No help for %.*s", (int)length, topic);
    }
}
