// Prints docs/reference.md from the command rows. Built for the host with all parts; `make
// reference` writes the page and a test compares it. Context: a program of its own.
#include <stdio.h>
#include <string.h>

#include "basic/functions.h"
#include "basic/statements.h"
#include "basic_cmds/basic_cmds.h"
#include "stepper/rules.h"

static const char *const kinds[] = {
    [BASIC_ARG_NUMBER] = "number",    [BASIC_ARG_INTEGER] = "whole number",
    [BASIC_ARG_TEXT] = "string",      [BASIC_ARG_CHOICE] = "word",
    [BASIC_ARG_WORD] = "word",        [BASIC_ARG_PIN] = "pin",
    [BASIC_ARG_ROUTINE] = "SUB",      [BASIC_ARG_DATA] = "numbers, a string or an array()",
    [BASIC_ARG_RAW] = "rest of line", [BASIC_ARG_STORE] = "variable or array()",
};

static bool has(const basic_arg_spec_t *arg, unsigned flag) {
    return (arg->flags & flag) != 0;
}

// What is written in an argument's place: its name, or the words that tell rows of one name apart.
static const char *place_of(const basic_arg_spec_t *arg) {
    return has(arg, BASIC_ARG_SELECTS) ? arg->choices : arg->name;
}

// " axis, step_pin [, enable_pin] ..." as the reference of the command set writes it.
static void print_syntax(const basic_arg_spec_t *args, size_t count) {
    bool repeating = false;
    for (size_t i = 0; i < count; i++) {
        const char *comma = i > 0 ? ", " : "";
        if (has(&args[i], BASIC_ARG_REPEAT)) {
            repeating = true;
            printf(" [%s%s", comma, place_of(&args[i]));
        } else if (has(&args[i], BASIC_ARG_OPTIONAL) && !repeating) {
            printf(i > 0 ? " [%s%s]" : "[%s%s]", comma, place_of(&args[i]));
        } else {
            printf("%s%s", comma, place_of(&args[i]));
        }
    }
    printf("%s", repeating ? "] ..." : "");
}

static void print_choices(const char *choices) {
    for (const char *p = choices; *p != '\0'; p++) {
        printf("%s", *p == '|' ? ", " : (char[2]){*p, '\0'});
    }
}

static void print_values(const basic_arg_spec_t *arg) {
    if (arg->kind == BASIC_ARG_CHOICE) {
        print_choices(arg->choices);
        return;
    }
    if (arg->min < arg->max) {
        printf("%s%.10g to %.10g", has(arg, BASIC_ARG_ABOVE_MIN) ? "above " : "", arg->min,
               arg->max);
    } else {
        printf("%s", kinds[arg->kind]);
    }
    if (arg->kind == BASIC_ARG_WORD && has(arg, BASIC_ARG_OR_NUMBER)) {
        printf(", or a word");
    }
    printf("%s%s", arg->unit != NULL ? " " : "", arg->unit != NULL ? arg->unit : "");
    if (arg->choices != NULL) {
        printf(", or ");
        print_choices(arg->choices);
    }
}

static void print_default(const basic_arg_spec_t *arg) {
    if (has(arg, BASIC_ARG_DEFAULT)) {
        printf("%.9g", arg->fallback);
    } else if (has(arg, BASIC_ARG_OPTIONAL)) {
        printf(arg->kind == BASIC_ARG_PIN ? "none" : "may be left out");
    } else if (has(arg, BASIC_ARG_REPEAT)) {
        printf("repeats");
    } else {
        printf("needed");
    }
}

static void print_args(const basic_arg_spec_t *args, size_t count) {
    if (count == 0) {
        return;
    }
    printf("| argument | what | values | if left out |\n| --- | --- | --- | --- |\n");
    for (size_t i = 0; i < count; i++) {
        printf("| %s | %s | ", args[i].name, args[i].help);
        print_values(&args[i]);
        printf(" | ");
        print_default(&args[i]);
        printf(" |\n");
    }
    printf("\n");
}

static void print_command(const basic_command_t *command) {
    printf("## %s\n\n```\n%s%s", command->name, command->name, command->arg_count > 0 ? " " : "");
    print_syntax(command->args, command->arg_count);
    printf("\n```\n\n%s.\n\n", command->help);
    print_args(command->args, command->arg_count);
}

static void print_function(const basic_function_t *function) {
    const char *keyword = function->keyword != NULL ? function->keyword : "";
    const char *gap = function->keyword != NULL && function->arg_count > 0 ? " " : "";
    if (function->keyword == NULL && function->arg_count == 0) {
        printf("## %s\n\n%s.\n\n", function->name, function->help);
        return;
    }
    printf("## %s(%s)\n\n```\n%s(%s%s", function->name, keyword, function->name, keyword, gap);
    print_syntax(function->args, function->arg_count);
    printf(")\n```\n\n%s.\n\n", function->help);
    print_args(function->args, function->arg_count);
}

static void print_assignment(const basic_assignment_t *row) {
    printf("## %s(...) =\n\n```\n%s(", row->name, row->name);
    print_syntax(row->args + 1, row->arg_count - 1);
    printf(") = %s\n```\n\n%s.\n\n", row->args[0].name, row->help);
    print_args(row->args, row->arg_count);
}

// A bar would end the cell of a table.
static void print_cell(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        printf("%s%c", text[i] == '|' ? "\\" : "", text[i]);
    }
}

static void print_language_row(const char *usage, size_t length, const char *help) {
    printf("| `");
    print_cell(usage, length);
    printf("` | ");
    print_cell(help, strlen(help));
    printf(" |\n");
}

static void print_statements(void) {
    printf("## Statements\n\nWords of BASIC that every program may use.\n\n"
           "| statement | what it does |\n| --- | --- |\n");
    for (size_t i = 0; i < statements_count; i++) {
        const statements_row_t *row = &statements_table[i];
        if (row->usage != NULL) {
            print_language_row(row->usage, strlen(row->usage), row->help);
        }
    }
    printf("\n");
}

// Their help is "usage: what".
static void print_functions(void) {
    printf("## Functions\n\n| function | value |\n| --- | --- |\n");
    for (size_t i = 0; i < functions_count; i++) {
        const char *help = functions_table[i].help;
        if (help != NULL) {
            const char *colon = strstr(help, ": ");
            print_language_row(help, (size_t)(colon - help), colon + 2);
        }
    }
}

static void print_commands(void) {
    for (size_t i = 0; i < basic_cmds_table_count; i++) {
        const basic_rows_t *table = basic_cmds_tables[i];
        for (size_t row = 0; row < table->command_count; row++) {
            print_command(&table->commands[row]);
        }
    }
}

static void print_product_functions(void) {
    for (size_t i = 0; i < basic_cmds_table_count; i++) {
        const basic_rows_t *table = basic_cmds_tables[i];
        for (size_t row = 0; row < table->function_count; row++) {
            print_function(&table->functions[row]);
        }
        for (size_t row = 0; row < table->assignment_count; row++) {
            print_assignment(&table->assignments[row]);
        }
    }
}

static void print_refused(rules_operation_t operation) {
    const char *before = "";
    for (int i = 0; i < RULES_CONDITIONS; i++) {
        if (rules_forbids(operation, (rules_condition_t)i)) {
            printf("%s%s", before, rules_condition_text((rules_condition_t)i));
            before = "; ";
        }
    }
    printf("%s", *before == '\0' ? "never" : "");
}

static void print_rules(void) {
    printf(
        "## What is refused when\n\n"
        "A refused command changes nothing and does not disturb what is under way. STATUS, PEEK "
        "and HELP always work.\n"
        "While STEPPER FILE carries a file out, lines of G-code, JOG, FILE, HOME RUN and DIALECT "
        "are refused as well.\n\n"
        "| STEPPER command | is refused |\n| --- | --- |\n");
    for (int i = 0; i < RULES_OPERATIONS; i++) {
        printf("| %s | ", rules_operation_text((rules_operation_t)i));
        print_refused((rules_operation_t)i);
        printf(" |\n");
    }
    printf("\nOf several reasons the one that stands first here is told:\n\n"
           "| state | error |\n| --- | --- |\n");
    for (int i = 0; i < RULES_CONDITIONS; i++) {
        err_raise(rules_condition_error((rules_condition_t)i), "...");
        printf("| %s | %s |\n", rules_condition_text((rules_condition_t)i), err_message());
    }
    printf("\n");
}

int main(void) {
    printf("# Command reference\n\n"
           "Made from the firmware's own tables; `HELP` at the prompt shows the same. Arguments in "
           "brackets may be\n"
           "left out, in the middle by leaving the place between two commas blank. A pin is `GP2`, "
           "`\"GP2\"` or a\n"
           "number: a GPIO number in STEPPER and TMC22xx, the number beside the board's pin in "
           "SETPIN and PIN "
           "(`OPTION PIN NUMBERS`\n"
           "makes it one rule). Where a pin may be left out, 0 means none. The [user "
           "guide](user-guide.md) "
           "shows how the commands\n"
           "work together.\n\n");
    print_commands();
    print_product_functions();
    print_rules();
    print_statements();
    print_functions();
    return 0;
}
