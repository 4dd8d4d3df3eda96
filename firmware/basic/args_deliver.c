// Values to arguments: conversion, range check and the error that names the argument. Then the
// call. Context: main loop.
#include <string.h>

#include "args.h"
#include "args_data.h"
#include "choices.h"
#include "errors.h"
#include "events.h"
#include "hal/pins.h"
#include "memory.h"
#include "number_text.h"
#include "rows.h"

#define UNLIMITED 1e300 // limits beyond this are not worth telling

static const char *shown_value(const value_t *value, char *buffer, size_t size) {
    if (value_is_numeric(value)) {
        char text[NUMBER_TEXT_SIZE];
        number_text_value(text, value);
        format_text(buffer, size, "%s", text);
    } else {
        format_text(buffer, size, "%.*s", (int)value->length, value->text);
    }
    return buffer;
}

static void describe_limits(const basic_arg_spec_t *spec, char *buffer, size_t size) {
    char least[NUMBER_TEXT_SIZE];
    char most[NUMBER_TEXT_SIZE];
    args_format_limit(least, spec->min);
    args_format_limit(most, spec->max);
    const char *above = spec->flags & BASIC_ARG_ABOVE_MIN ? "above " : "";
    if (spec->min == 0.0 && spec->max == 0.0) {
        format_text(buffer, size, "any number");
    } else if (spec->max >= UNLIMITED) {
        format_text(buffer, size, "%s%s%s", above, least, *above != '\0' ? "" : " or more");
    } else if (spec->min <= -UNLIMITED) {
        format_text(buffer, size, "%s or less", most);
    } else {
        format_text(buffer, size, "%s%s to %s", above, least, most);
    }
}

void args_describe_range(const basic_arg_spec_t *spec, char *buffer, size_t size) {
    size_t used = 0;
    if (spec->kind != BASIC_ARG_CHOICE) {
        describe_limits(spec, buffer, size);
        used = strlen(buffer);
    }
    if (spec->choices != NULL) {
        used += format_text(buffer + used, size - used, used > 0 ? ", " : "");
        choices_list(spec->choices, buffer + used, size - used);
    }
}

// Limits are shown in full: 100000000, not 1e+08.
void args_format_limit(char *buffer, double limit) {
    if (limit > -1e15 && limit < 1e15 && limit == (double)(int64_t)limit) {
        num_text_integer(buffer, (int64_t)limit);
    } else {
        number_text_float(buffer, limit);
    }
}

static _Noreturn void fail_range(const basic_arg_spec_t *spec, const value_t *value) {
    char range[96];
    char shown[48];
    args_describe_range(spec, range, sizeof range);
    errors_fail_with(ERR_ARGUMENT, "%s: %s is invalid (valid is %s)", spec->name,
                     shown_value(value, shown, sizeof shown), range);
}

static void check_range(const basic_arg_spec_t *spec, double number, const value_t *value) {
    if (spec->min == 0.0 && spec->max == 0.0) {
        return;
    }
    bool low = spec->flags & BASIC_ARG_ABOVE_MIN ? !(number > spec->min) : !(number >= spec->min);
    if (low || !(number <= spec->max)) {
        fail_range(spec, value);
    }
}

static void deliver_number(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg) {
    if (!value_is_numeric(value)) {
        errors_fail_with(ERR_ARGUMENT, "%s: expected a number", spec->name);
    }
    arg->number = value_to_number(value);
    if (spec->kind != BASIC_ARG_NUMBER) {
        if (arg->number < -9.2e18 || arg->number > 9.2e18) {
            fail_range(spec, value);
        }
        arg->integer = value_to_integer(value);
        arg->number = (double)arg->integer;
    }
    check_range(spec, arg->number, value);
}

static void deliver_text(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg) {
    if (value->type != VALUE_STRING && value->type != VALUE_WORD) {
        errors_fail_with(ERR_ARGUMENT, "%s: expected a string", spec->name);
    }
    arg->text = (basic_text_t){value->text, value->length};
}

static void deliver_choice(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg) {
    char number[NUMBER_TEXT_SIZE];
    const char *text = value->text;
    size_t length = value->length;
    if (value_is_numeric(value)) {
        length = number_text_value(number, value);
        text = number;
    }
    arg->integer = choices_find(spec->choices, text, length);
    if (arg->integer < 0) {
        fail_range(spec, value);
    }
    arg->number = (double)arg->integer;
    arg->text.text = choices_get(spec->choices, (int)arg->integer, &arg->text.length);
}

// The GPIO, or PINS_NONE.
static unsigned pin_of_text(const value_t *value) {
    const char *text = value->text;
    if (value->length < 3 || value->length > 4 || (text[0] | 0x20) != 'g' ||
        (text[1] | 0x20) != 'p') {
        return PINS_NONE;
    }
    unsigned gpio = 0;
    for (size_t i = 2; i < value->length; i++) {
        if (text[i] < '0' || text[i] > '9') {
            return PINS_NONE;
        }
        gpio = gpio * 10 + (unsigned)(text[i] - '0');
    }
    return gpio;
}

static bool is_board_number(const basic_arg_spec_t *spec) {
    int64_t rule = basic_option(BASIC_PIN_NUMBERS, BASIC_PIN_NUMBERS_BY_ROW);
    return rule == BASIC_PIN_NUMBERS_BOARD ||
           (rule != BASIC_PIN_NUMBERS_GPIO && (spec->flags & BASIC_ARG_BOARD_NUMBER) != 0);
}

static unsigned small_number(const value_t *value) {
    double number = value_to_number(value);
    return number >= -0.5 && number < PINS_NONE ? (unsigned)value_round(number) : PINS_NONE;
}

// The argument's name says nothing where it is "pin".
static _Noreturn void fail_pin(const basic_arg_spec_t *spec, const value_t *value,
                               const char *why) {
    char shown[32];
    bool told = strcmp(spec->name, "pin") == 0;
    errors_fail_with(ERR_PIN_INVALID, "%s%s%s (%s)", shown_value(value, shown, sizeof shown),
                     told ? "" : " for ", told ? "" : spec->name, why);
}

static bool means_no_pin(const basic_arg_spec_t *spec, const value_t *value) {
    return (spec->flags & BASIC_ARG_OPTIONAL) != 0 && value_is_numeric(value) &&
           (value->flags & VALUE_LITERAL) != 0 && value->type == VALUE_INTEGER &&
           value->integer == 0;
}

static void deliver_pin(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg) {
    if (means_no_pin(spec, value)) {
        arg->integer = PINS_NONE;
        return;
    }
    unsigned gpio;
    if (!value_is_numeric(value)) {
        gpio = pin_of_text(value);
    } else if (is_board_number(spec)) {
        unsigned number = small_number(value);
        gpio = pins_from_board_number(number);
        if (gpio == PINS_NONE) {
            fail_pin(spec, value, pins_why_not_board_number(number));
        }
    } else {
        gpio = small_number(value);
    }
    if (!pins_is_user(gpio)) {
        fail_pin(spec, value, pins_why_not(gpio));
    }
    arg->integer = gpio;
    arg->number = (double)gpio;
}

basic_routine_t args_routine(const char *name, const value_t *value) {
    if (!value_is_numeric(value)) {
        return events_routine(value->text, value->length);
    }
    if (value_to_number(value) != 0.0) {
        errors_fail_with(ERR_ARGUMENT, "%s: expected the name of a SUB", name);
    }
    return 0;
}

static void deliver(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg) {
    arg->given = true;
    switch (spec->kind) {
    case BASIC_ARG_NUMBER:
    case BASIC_ARG_INTEGER:
        if (spec->choices != NULL && !value_is_numeric(value)) {
            deliver_choice(spec, value, arg);
        } else {
            deliver_number(spec, value, arg);
        }
        break;
    case BASIC_ARG_WORD:
        if ((spec->flags & BASIC_ARG_OR_NUMBER) != 0 && value_is_numeric(value)) {
            deliver_number(spec, value, arg);
        } else {
            deliver_text(spec, value, arg);
        }
        break;
    case BASIC_ARG_CHOICE:
        deliver_choice(spec, value, arg);
        break;
    case BASIC_ARG_PIN:
        deliver_pin(spec, value, arg);
        break;
    case BASIC_ARG_STORE:
        args_data_deliver_store(spec, value, arg);
        break;
    case BASIC_ARG_ROUTINE:
        arg->integer = args_routine(spec->name, value);
        break;
    default:
        deliver_text(spec, value, arg);
        break;
    }
}

static void deliver_blank(const basic_arg_spec_t *spec, basic_arg_t *arg) {
    if (!(spec->flags & (BASIC_ARG_OPTIONAL | BASIC_ARG_DEFAULT))) {
        errors_fail_with(ERR_ARGUMENTS_MISSING, "%s", spec->name);
    }
    if (spec->kind == BASIC_ARG_PIN) {
        arg->integer = PINS_NONE;
    } else if (spec->flags & BASIC_ARG_DEFAULT) {
        arg->number = spec->fallback;
        arg->integer = (int64_t)spec->fallback;
    }
}

// Where the repeated group starts; spec_count if there is none.
static size_t group_start(const basic_arg_spec_t *specs, size_t spec_count) {
    size_t start = 0;
    while (start < spec_count && !(specs[start].flags & BASIC_ARG_REPEAT)) {
        start++;
    }
    return start;
}

void args_deliver(const basic_arg_spec_t *specs, size_t spec_count, const value_t *values,
                  unsigned count, basic_arg_t *out, size_t *out_count) {
    size_t start = group_start(specs, spec_count);
    size_t group = spec_count - start;
    size_t total = start;
    while (total < count && group != 0) { // whole groups only: the rest of the last one is blank
        total += group;
    }
    bool takes_data = args_takes_data(specs, spec_count);
    if ((count > total && !takes_data) || total > BASIC_ARGS_MAX) {
        errors_fail(ERR_ARGUMENTS_TOO_MANY);
    }
    for (size_t i = 0; i < total; i++) {
        const basic_arg_spec_t *spec = i < start ? &specs[i] : &specs[start + (i - start) % group];
        out[i] = (basic_arg_t){.text = {"", 0}};
        if (i < count && spec->kind == BASIC_ARG_DATA) {
            args_data_deliver(spec, &values[i], count - (unsigned)i, &out[i]);
        } else if (i < count && values[i].type != VALUE_NONE) {
            deliver(spec, &values[i], &out[i]);
        } else {
            deliver_blank(spec, &out[i]);
        }
    }
    *out_count = total;
}

// ---- The calls ----------------------------------------------------------------------------------

static basic_arg_t delivered[BASIC_ARGS_MAX]; // a row's function never leads to another's

void args_run(const uint8_t *row, const value_t *values, unsigned count) {
    const basic_command_t *command = rows_command_at(row);
    size_t total;
    args_deliver(command->args, command->arg_count, values, count, delivered, &total);
    if (command->run(delivered, total) != ERR_OK) {
        errors_fail_raised();
    }
}

void args_assign(const uint8_t *row, value_t *values, unsigned count) {
    const basic_assignment_t *assignment = rows_assignment_at(row);
    value_t value = values[count - 1];
    memmove(values + 1, values, (count - 1) * sizeof *values);
    values[0] = value;
    size_t total;
    args_deliver(assignment->args, assignment->arg_count, values, count, delivered, &total);
    if (assignment->run(delivered, total) != ERR_OK) {
        errors_fail_raised();
    }
}

void args_evaluate(const uint8_t *row, value_t *values, unsigned count) {
    const basic_function_t *function = rows_function_at(row);
    size_t total;
    args_deliver(function->args, function->arg_count, values, count, delivered, &total);
    basic_value_t result = {.type = BASIC_INTEGER, .integer = 0};
    if (function->evaluate(delivered, total, &result) != ERR_OK) {
        errors_fail_raised();
    }
    values[0].flags = 0;
    switch (result.type) {
    case BASIC_INTEGER:
        value_set_integer(&values[0], result.integer);
        break;
    case BASIC_FLOAT:
        value_set_number(&values[0], result.number);
        break;
    case BASIC_STRING: {
        size_t length =
            result.text.length < VALUE_STRING_MAX ? result.text.length : VALUE_STRING_MAX;
        char *copy = memory_text(length);
        memcpy(copy, result.text.text, length);
        value_set_text(&values[0], copy, length);
        break;
    }
    }
}
