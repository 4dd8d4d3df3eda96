// PRINT, INPUT and LINE INPUT at run time. Context: main loop.
#include <string.h>

#include "actions.h"
#include "channels.h"
#include "console.h"
#include "errors.h"
#include "line_editor.h"
#include "number_text.h"

void actions_print_value(value_t *arguments, unsigned count) {
    (void)count;
    if (arguments->type == VALUE_STRING) {
        console_write(arguments->text, arguments->length);
        return;
    }
    char text[NUMBER_TEXT_SIZE];
    size_t length = number_text_value(text, arguments);
    if (text[0] != '-') {
        console_write(" ", 1);
    }
    console_write(text, length);
}

void actions_print_comma(value_t *arguments, unsigned count) {
    (void)arguments;
    (void)count;
    console_write("\t", 1);
}

void actions_print_tab(value_t *arguments, unsigned count) {
    (void)count;
    int64_t column = value_to_integer(arguments);
    if (column < 1 || column > VALUE_STRING_MAX) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    if (console_column() > (unsigned)column - 1) {
        console_new_line();
    }
    while (console_column() < (unsigned)column - 1) {
        console_write(" ", 1);
    }
}

void actions_cls(value_t *arguments, unsigned count) {
    (void)arguments;
    (void)count;
    console_print("\x1b[2J\x1b[H");
    console_set_column(0);
}

// column, row, from 0 at the top left
void actions_print_at(value_t *arguments, unsigned count) {
    (void)count;
    int64_t column = value_to_integer(&arguments[0]);
    int64_t row = value_to_integer(&arguments[1]);
    if (column < 0 || column >= VALUE_STRING_MAX || row < 0 || row >= VALUE_STRING_MAX) {
        errors_fail(ERR_NUMBER_OUT_OF_BOUNDS);
    }
    char text[24];
    format_text(text, sizeof text, "\x1b[%u;%uH", (unsigned)row + 1, (unsigned)column + 1);
    console_print(text);
    console_set_column((unsigned)column);
}

void actions_print_line(value_t *arguments, unsigned count) {
    (void)arguments;
    (void)count;
    console_new_line();
}

// ---- Input --------------------------------------------------------------------------------------

static struct {
    char text[LINE_EDITOR_MAX + 1];
    const char *rest; // what INPUT has not taken yet; NULL: nothing is left
} input;

static void read_line(const char *prompt) {
    const line_editor_options_t options = {.prompt = prompt};
    const char *line;
    size_t length;
    switch (line_editor_read(&options, &line, &length)) {
    case LINE_EDITOR_BREAK:
        errors_break();
    case LINE_EDITOR_TOO_LONG:
        errors_fail(ERR_LINE_TOO_LONG);
    case LINE_EDITOR_END:
        errors_fail(ERR_END_OF_INPUT);
    default:
        break;
    }
    memcpy(input.text, line, length);
    input.text[length] = '\0';
    input.rest = input.text;
}

static const char *prompt_of(const value_t *text, bool question) {
    static char prompt[VALUE_STRING_MAX + 3];
    memcpy(prompt, text->text, text->length);
    strcpy(prompt + text->length, question ? "? " : "");
    return prompt;
}

void actions_input_line(value_t *arguments, unsigned count) {
    (void)count;
    read_line(prompt_of(&arguments[0], value_is_true(&arguments[1])));
}

static void read_channel(const value_t *channel) {
    unsigned number = channels_number(channel);
    if (number == 0) {
        read_line("");
        return;
    }
    input.text[channels_read_line(number, input.text)] = '\0';
    input.rest = input.text;
}

void actions_input_channel(value_t *arguments, unsigned count) {
    (void)count;
    read_channel(arguments);
}

// The next field up to a comma outside quotes, without blanks around it.
static value_t next_field(void) {
    value_t field;
    value_set_text(&field, "", 0);
    if (input.rest == NULL) {
        return field;
    }
    const char *start = input.rest;
    bool quoted = false;
    const char *p = start;
    for (; *p != '\0' && (quoted || *p != ','); p++) {
        quoted ^= *p == '"';
    }
    input.rest = *p == ',' ? p + 1 : NULL;
    const char *end = p;
    while (start < end && *start == ' ') {
        start++;
    }
    while (end > start && end[-1] == ' ') {
        end--;
    }
    if (end - start >= 2 && *start == '"' && end[-1] == '"') {
        start++;
        end--;
    }
    value_set_text(&field, start, (size_t)(end - start));
    return field;
}

void actions_input_field(value_t *arguments, unsigned count) {
    (void)count;
    value_t field = next_field();
    if (arguments->type != VALUE_STRING_REF) {
        value_t number;
        number_text_parse(field.text, field.length, &number);
        field = number;
    }
    value_write(arguments, &field);
}

void actions_line_input(value_t *arguments, unsigned count) {
    (void)count;
    if (arguments[0].type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    read_line(prompt_of(&arguments[0], false));
    value_t line;
    value_set_text(&line, input.text, strlen(input.text));
    value_write(&arguments[1], &line);
}

void actions_line_input_channel(value_t *arguments, unsigned count) {
    (void)count;
    unsigned number = channels_number(&arguments[0]);
    value_t line;
    if (number == 0) {
        read_line("");
        value_set_text(&line, input.text, strlen(input.text));
    } else {
        value_set_text(&line, input.text, channels_read_line(number, input.text));
    }
    value_write(&arguments[1], &line);
}
