// Variables and what describes them. A string's bytes are its length and its text, in the size it
// was declared with. Context: main loop.
#include "saved_record.h"

#include <string.h>

#include "errors.h"

static void describe_array(const variables_array_t *array, saved_record_t *record) {
    record->type = array->type;
    record->dimensions = array->dimensions;
    record->base = array->base;
    record->capacity = (uint8_t)array->capacity;
    memcpy(record->extent, array->extent, sizeof record->extent);
}

static void describe_value(const value_t *slot, saved_record_t *record) {
    bool is_text = slot->type == VALUE_STRING_REF;
    record->type = is_text ? VALUE_STRING : slot->type;
    record->capacity = is_text ? (uint8_t)slot->capacity : 0;
}

// Where the values are, and how many bytes they take.
static void *values_of(symbols_t *symbol, uint32_t *size) {
    value_t *slot = &symbol->value;
    if (slot->type == VALUE_ARRAY) {
        variables_array_t *array = slot->data;
        *size = array->count * variables_element_size(array);
        return array->elements;
    }
    if (slot->type == VALUE_STRING_REF) {
        *size = slot->capacity + 1u;
        return slot->data;
    }
    *size = sizeof slot->integer;
    return &slot->integer;
}

static void describe(symbols_t *symbol, saved_record_t *record, void **values) {
    const value_t *slot = &symbol->value;
    memset(record, 0, sizeof *record);
    record->check = SAVED_RECORD_CHECK;
    record->name_length = symbol->length;
    memcpy(record->name, symbol->name, symbol->length);
    if (slot->type == VALUE_ARRAY) {
        describe_array(slot->data, record);
    } else {
        describe_value(slot, record);
    }
    *values = values_of(symbol, &record->size);
}

static void check_variable(const symbols_t *symbol) {
    if (symbol->value.type == VALUE_NONE) {
        errors_fail_with(ERR_NOT_DECLARED, "%.*s", symbol->length, symbol->name);
    }
    if (symbol->value.flags & VALUE_CONSTANT) {
        errors_fail(ERR_CONSTANT);
    }
}

void saved_record_describe(const symbols_t *symbol, saved_record_t *record, const void **values) {
    void *place;
    check_variable(symbol);
    describe((symbols_t *)(uintptr_t)symbol, record, &place);
    *values = place;
}

// ---- Back ---------------------------------------------------------------------------------------

static void declare(symbols_t *symbol, const saved_record_t *record) {
    value_t bounds[VARIABLES_DIMENSIONS_MAX];
    if (symbol->type != VALUE_NONE && symbol->type != record->type) {
        errors_fail_with(ERR_DIFFERENT_TYPE, "%.*s", symbol->length, symbol->name);
    }
    for (unsigned i = 0; i < record->dimensions; i++) {
        value_set_integer(&bounds[i], (int64_t)record->extent[i] + record->base - 1);
    }
    uint8_t base = vm.base;
    vm.base = record->base;
    variables_declare(memory_handle(symbol), record->type, record->capacity, bounds,
                      record->dimensions);
    vm.base = base;
    symbol->type = record->type;
}

void saved_record_find(const saved_record_t *record, void **values) {
    symbols_t *symbol = symbols_get(SYMBOLS_VARIABLE, 0, record->name, record->name_length);
    if (symbol->value.type == VALUE_NONE) {
        declare(symbol, record);
    }
    check_variable(symbol);
    saved_record_t own;
    describe(symbol, &own, values);
    if (memcmp(&own, record, sizeof own) != 0) {
        errors_fail_with(ERR_DIFFERENT_TYPE, "%.*s", symbol->length, symbol->name);
    }
}

bool saved_record_is_sound(const saved_record_t *record) {
    uint64_t count = 1;
    if (record->type > VALUE_STRING || record->dimensions > VARIABLES_DIMENSIONS_MAX ||
        record->base > 1 || record->name_length == 0 || record->name_length > SYMBOLS_NAME_MAX) {
        return false;
    }
    for (unsigned i = 0; i < record->dimensions; i++) {
        count *= record->extent[i];
        if (count == 0 || count > UINT32_MAX) {
            return false;
        }
    }
    uint64_t each = record->type == VALUE_STRING ? record->capacity + 1u : sizeof(int64_t);
    return record->size == count * each;
}
