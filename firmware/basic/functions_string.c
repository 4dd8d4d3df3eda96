// Functions of texts. Results are temporary strings, which live to the end of the statement.
// Context: main loop.
#include <string.h>

#include "errors.h"
#include "functions.h"
#include "memory.h"
#include "number_text.h"

#define FUNCTION(name) void functions_##name(value_t *arguments, unsigned count, value_t *result)

// `value` if it is from `least` to `most`; otherwise an error that says so.
static size_t in_range(const value_t *value, int64_t least, int64_t most) {
    if (value->integer < least || value->integer > most) {
        char text[32];
        num_text_integer(text, value->integer);
        errors_fail_with(ERR_ARGUMENT, "%s is invalid (valid is %d to %d)", text, (int)least,
                         (int)most);
    }
    return (size_t)value->integer;
}

static void set_copy(value_t *result, const char *text, size_t length) {
    char *copy = memory_text(length);
    memcpy(copy, text, length);
    value_set_text(result, copy, length);
}

FUNCTION(len) {
    (void)count;
    value_set_integer(result, arguments->length);
}

FUNCTION(asc) {
    (void)count;
    value_set_integer(result, arguments->length == 0 ? 0 : (unsigned char)arguments->text[0]);
}

FUNCTION(chr) {
    (void)count;
    char c = (char)in_range(arguments, 0, 255);
    set_copy(result, &c, 1);
}

FUNCTION(left) {
    (void)count;
    size_t wanted = in_range(&arguments[1], 0, VALUE_STRING_MAX);
    value_set_text(result, arguments->text,
                   wanted < arguments->length ? wanted : arguments->length);
}

FUNCTION(right) {
    (void)count;
    size_t wanted = in_range(&arguments[1], 0, VALUE_STRING_MAX);
    size_t length = wanted < arguments->length ? wanted : arguments->length;
    value_set_text(result, arguments->text + arguments->length - length, length);
}

FUNCTION(mid) {
    size_t start = in_range(&arguments[1], 1, VALUE_STRING_MAX) - 1;
    size_t wanted = count > 2 ? in_range(&arguments[2], 0, VALUE_STRING_MAX) : VALUE_STRING_MAX;
    size_t rest = start < arguments->length ? arguments->length - start : 0;
    value_set_text(result, rest > 0 ? arguments->text + start : "", wanted < rest ? wanted : rest);
}

static void change_case(const value_t *argument, value_t *result, char first, char last) {
    char *text = memory_text(argument->length);
    for (size_t i = 0; i < argument->length; i++) {
        char c = argument->text[i];
        text[i] = c >= first && c <= last ? (char)(c ^ 0x20) : c;
    }
    value_set_text(result, text, argument->length);
}

FUNCTION(ucase) {
    (void)count;
    change_case(arguments, result, 'a', 'z');
}

FUNCTION(lcase) {
    (void)count;
    change_case(arguments, result, 'A', 'Z');
}

static void set_repeated(value_t *result, size_t length, char c) {
    char *text = memory_text(length);
    memset(text, c, length);
    value_set_text(result, text, length);
}

FUNCTION(space) {
    (void)count;
    set_repeated(result, in_range(arguments, 0, VALUE_STRING_MAX), ' ');
}

FUNCTION(string) {
    (void)count;
    size_t length = in_range(arguments, 0, VALUE_STRING_MAX);
    value_t *what = &arguments[1];
    if (what->type == VALUE_STRING) {
        if (what->length == 0) {
            errors_fail(ERR_ARGUMENT_COUNT);
        }
        set_repeated(result, length, what->text[0]);
        return;
    }
    value_set_integer(what, value_to_integer(what));
    set_repeated(result, length, (char)in_range(what, 0, 255));
}

FUNCTION(instr) {
    size_t start = 0;
    if (count == 3) {
        value_set_integer(arguments, value_to_integer(arguments));
        start = in_range(arguments, 0, VALUE_STRING_MAX);
        start -= start > 0;
        arguments++;
    }
    if (arguments[0].type != VALUE_STRING || arguments[1].type != VALUE_STRING) {
        errors_fail(ERR_EXPECTED_STRING);
    }
    size_t length = arguments[1].length;
    if (length == 0) {
        return;
    }
    for (size_t i = start; i + length <= arguments[0].length; i++) {
        if (memcmp(arguments[0].text + i, arguments[1].text, length) == 0) {
            value_set_integer(result, (int64_t)i + 1);
            return;
        }
    }
}

static void set_in_base(value_t *arguments, unsigned count, value_t *result, unsigned base) {
    char text[NUMBER_TEXT_SIZE];
    size_t width = count > 1 ? in_range(&arguments[1], 0, 64) : 0;
    size_t length = num_text_unsigned(text, (uint64_t)arguments->integer, base, width);
    set_copy(result, text, length);
}

FUNCTION(hex) {
    set_in_base(arguments, count, result, 16);
}

FUNCTION(oct) {
    set_in_base(arguments, count, result, 8);
}

FUNCTION(bin) {
    set_in_base(arguments, count, result, 2);
}

FUNCTION(val) {
    (void)count;
    number_text_parse(arguments->text, arguments->length, result);
}

static bool contains(const char *set, size_t length, char c) {
    return memchr(set, c, length) != NULL;
}

FUNCTION(trim) {
    const char *set = count > 1 ? arguments[1].text : " ";
    size_t set_length = count > 1 ? arguments[1].length : 1;
    char side = count > 2 && arguments[2].length > 0 ? (char)(arguments[2].text[0] | 0x20) : 'l';
    if (side != 'l' && side != 'r' && side != 'b') {
        errors_fail(ERR_SYNTAX);
    }
    const char *text = arguments->text;
    size_t length = arguments->length;
    while (side != 'r' && length > 0 && contains(set, set_length, text[0])) {
        text++;
        length--;
    }
    while (side != 'l' && length > 0 && contains(set, set_length, text[length - 1])) {
        length--;
    }
    value_set_text(result, text, length);
}

// The part of the text up to the next separator outside quotes; *text goes behind it.
static size_t next_field(const char **text, const char *end, const value_t *separators,
                         const value_t *quotes) {
    const char *start = *text;
    char quote = '\0';
    const char *p = start;
    for (; p < end; p++) {
        if (quote != '\0') {
            quote = *p == quote ? '\0' : quote;
        } else if (quotes != NULL && contains(quotes->text, quotes->length, *p)) {
            quote = *p;
        } else if (contains(separators->text, separators->length, *p)) {
            break;
        }
    }
    *text = p < end ? p + 1 : NULL;
    return (size_t)(p - start);
}

FUNCTION(field) {
    value_t comma;
    value_set_text(&comma, ",", 1);
    const value_t *separators = count > 2 ? &arguments[2] : &comma;
    const value_t *quotes = count > 3 ? &arguments[3] : NULL;
    size_t wanted = in_range(&arguments[1], 1, VALUE_STRING_MAX);
    const char *text = arguments->text;
    const char *end = text + arguments->length;
    value_set_text(result, "", 0);
    for (size_t i = 1; text != NULL; i++) {
        const char *start = text;
        size_t length = next_field(&text, end, separators, quotes);
        if (i < wanted) {
            continue;
        }
        while (length > 0 && *start == ' ') {
            start++;
            length--;
        }
        while (length > 0 && start[length - 1] == ' ') {
            length--;
        }
        value_set_text(result, start, length);
        return;
    }
}
