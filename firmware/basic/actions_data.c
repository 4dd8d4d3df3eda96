// READ and RESTORE: where in the program's DATA the next value is. Context: main loop.
#include <string.h>

#include "actions.h"
#include "code.h"
#include "errors.h"
#include "escapes.h"
#include "memory.h"
#include "number_text.h"
#include "variables.h"
#include "vm.h"

#define SAVED_MAX 8

typedef struct {
    uint32_t current; // place of the DATA being read, 0: all are read
    uint32_t offset;  // into its text
} place_t;

static struct {
    uint32_t first; // place of the program's first DATA, 0: there is none
    place_t at;
    place_t saved[SAVED_MAX]; // READ SAVE
    unsigned saved_count;
} data;

void actions_data_reset(uint32_t first) {
    data.first = first;
    data.at = (place_t){first, 0};
    data.saved_count = 0;
}

void actions_read_save(value_t *arguments, unsigned count) {
    (void)arguments;
    (void)count;
    if (data.saved_count == SAVED_MAX) {
        errors_fail_with(ERR_NESTED_TOO_DEEP, "READ SAVE");
    }
    data.saved[data.saved_count++] = data.at;
}

void actions_read_restore(value_t *arguments, unsigned count) {
    (void)arguments;
    (void)count;
    if (data.saved_count == 0) {
        errors_fail(ERR_NO_READ_SAVE);
    }
    data.at = data.saved[--data.saved_count];
}

// OP_DATA, place of the next one (3 bytes), length, text
static const uint8_t *current_text(unsigned *length) {
    const uint8_t *instruction = memory.base + data.at.current;
    *length = instruction[4];
    return instruction + 5;
}

static void go_to_next(void) {
    data.at.current = code_u24(memory.base + data.at.current + 1);
    data.at.offset = 0;
}

// The end of the item that starts at `offset`: the comma behind it, or the end of the text.
static unsigned item_end(const uint8_t *text, unsigned offset, unsigned length) {
    bool quoted = false;
    while (offset < length && (quoted || text[offset] != ',')) {
        bool escape = quoted && vm.escapes && text[offset] == '\\' && offset + 1 < length;
        quoted ^= text[offset] == '"';
        offset += escape ? 2 : 1;
    }
    return offset;
}

// A quoted text, after OPTION ESCAPE without its escapes.
static void set_quoted(value_t *item, const char *text, size_t length) {
    if (vm.escapes) {
        char *replaced = memory_text(length);
        length = escapes_replace(replaced, text, length);
        text = replaced;
    }
    value_set_text(item, text, length);
}

static value_t next_item(bool *quoted) {
    if (data.at.current == 0) {
        errors_fail(ERR_NO_DATA);
    }
    unsigned length;
    const uint8_t *text = current_text(&length);
    unsigned start = data.at.offset;
    unsigned end = item_end(text, start, length);
    if (end < length) {
        data.at.offset = end + 1;
    } else {
        go_to_next();
    }
    while (start < end && text[start] == ' ') {
        start++;
    }
    while (end > start && text[end - 1] == ' ') {
        end--;
    }
    value_t item;
    *quoted = start < end && text[start] == '"';
    if (*quoted) {
        start++;
        end -= end > start && text[end - 1] == '"';
        set_quoted(&item, (const char *)text + start, end - start);
    } else {
        value_set_text(&item, (const char *)text + start, end - start);
    }
    return item;
}

// Into what the reference names.
static void read_one(const value_t *reference) {
    bool quoted;
    value_t item = next_item(&quoted);
    if (reference->type != VALUE_STRING_REF) {
        value_t number;
        if (quoted || number_text_parse(item.text, item.length, &number) != item.length ||
            item.length == 0) {
            errors_fail(ERR_EXPECTED_NUMBER);
        }
        item = number;
    }
    value_write(reference, &item);
}

void actions_read(value_t *arguments, unsigned count) {
    (void)count;
    if (arguments->type != VALUE_ARRAY) {
        read_one(arguments);
        return;
    }
    const variables_array_t *array = arguments->data;
    for (uint32_t i = 0; i < array->count; i++) {
        value_t element;
        variables_nth(array, i, &element);
        read_one(&element);
    }
}

// Without an argument: from the first DATA. With one: from the first behind that place.
void actions_restore(value_t *arguments, unsigned count) {
    uint32_t place = 0;
    if (count != 0) {
        uint8_t bytes[sizeof arguments->integer];
        memcpy(bytes, &arguments->integer, sizeof bytes);
        place = code_u24(bytes);
        if (memory.base[place] == OP_FAIL) { // the label was not found
            vm.pc = memory.base + place;
            return;
        }
    }
    data.at.current = data.first;
    data.at.offset = 0;
    while (data.at.current != 0 && data.at.current < place) {
        go_to_next();
    }
}
