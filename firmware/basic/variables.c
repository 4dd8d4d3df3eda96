// Variables and arrays at run time. Context: main loop.
#include "variables.h"

#include <string.h>

#include "calls.h"
#include "errors.h"
#include "names.h"
#include "symbols.h"

#define SIZE_MAX_OF_ARRAY (1u << 24) // bytes; more than any memory has
#define UPPER_MAX 131067 // highest bound of an array's dimension; memory ends long before

static bool is_local(uint16_t variable) {
    return (variable & CODE_LOCAL_FLAG) != 0;
}

const char *variables_name(uint16_t variable) {
    static char name[SYMBOLS_NAME_MAX + 1];
    if (is_local(variable)) {
        size_t length;
        const char *text = names_of_local(calls_routine(), variable & ~CODE_LOCAL_FLAG, &length);
        for (size_t i = 0; i < length; i++) {
            name[i] = letters_upper(text[i]);
        }
        name[length] = '\0';
        return name;
    }
    const symbols_t *symbol = memory_place(variable);
    return symbol->name;
}

// Memory as long-lived as the variable. A local's is taken at the start of a statement's scratch,
// so that it stays when the temporary strings go.
static void *allocate(uint16_t variable, size_t size) {
    if (!is_local(variable)) {
        return memory_heap(size);
    }
    void *place = memory_scratch(size);
    vm.scratch_base = memory.scratch;
    return place;
}

static char *allocate_text(bool passing, unsigned capacity) {
    char *bytes;
    if (passing) {
        bytes = memory_text(capacity + 1);
        vm.scratch_base = memory.scratch;
    } else {
        bytes = memory_heap_text(capacity + 1);
    }
    bytes[0] = '\0';
    return bytes;
}

// Gives a variable an empty string of its own.
static void make_string(uint16_t variable, unsigned capacity) {
    char *bytes = allocate_text(is_local(variable), capacity);
    value_t *slot = variables_slot(variable);
    slot->data = bytes;
    slot->capacity = (uint16_t)capacity;
    slot->type = VALUE_STRING_REF;
}

void variables_make_hidden_string(uint16_t variable, value_t *place) {
    bool passing = is_local(variable) || memory_is_passing(place);
    place->data = allocate_text(passing, VALUE_STRING_MAX);
    place->capacity = VALUE_STRING_MAX;
    place->flags = 0;
    place->type = VALUE_STRING_REF;
}

static void make_scalar(uint16_t variable, uint8_t type, unsigned capacity) {
    value_t *slot = variables_slot(variable);
    slot->flags = 0;
    if (type == VALUE_STRING) {
        make_string(variable, capacity);
    } else {
        slot->integer = 0; // all bits 0 is 0.0 as well
        slot->type = type;
    }
}

void variables_create(uint16_t variable) {
    if (is_local(variable) || vm.explicit_names) {
        errors_fail_with(ERR_NOT_DECLARED, "%s", variables_name(variable));
    }
    const symbols_t *symbol = memory_place(variable);
    uint8_t type = symbol->type != VALUE_NONE ? symbol->type : vm.default_type;
    if (type == VALUE_NONE) {
        errors_fail(ERR_NO_TYPE);
    }
    make_scalar(variable, type, VALUE_STRING_MAX);
}

void variables_store(uint16_t variable, const value_t *value) {
    value_t *slot = variables_slot(variable);
    if (slot->type == VALUE_NONE) {
        variables_create(variable);
    }
    if (slot->flags & VALUE_CONSTANT) {
        errors_fail(ERR_CONSTANT);
    }
    if (slot->type == VALUE_FLOAT) {
        slot->number = value_to_number(value);
    } else if (slot->type == VALUE_INTEGER) {
        slot->integer = value_to_integer(value);
    } else {
        value_write(slot, value);
    }
}

void variables_reference(uint16_t variable, bool array, value_t *out) {
    value_t *slot = variables_slot(variable);
    if (slot->type == VALUE_NONE) {
        if (array) {
            errors_fail_with(ERR_NOT_DECLARED, "%s", variables_name(variable));
        }
        variables_create(variable);
    }
    if (array != (slot->type == VALUE_ARRAY)) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    *out = *slot;
    if (slot->flags & VALUE_CONSTANT) {
        out->flags = 0;
        value_fetch(out);
    } else if (slot->type == VALUE_FLOAT) {
        out->data = &slot->number;
        out->type = VALUE_FLOAT_REF;
    } else if (slot->type == VALUE_INTEGER) {
        out->data = &slot->integer;
        out->type = VALUE_INTEGER_REF;
    }
}

variables_array_t *variables_array(uint16_t variable) {
    value_t *slot = variables_slot(variable);
    if (slot->type == VALUE_NONE) {
        errors_fail_with(ERR_NOT_DECLARED, "%s", variables_name(variable));
    }
    if (slot->type != VALUE_ARRAY) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    return slot->data;
}

void variables_nth(const variables_array_t *array, uint32_t index, value_t *out) {
    if (index >= array->count) {
        errors_fail(ERR_INDEX_OUT_OF_BOUNDS);
    }
    out->flags = 0;
    out->capacity = array->capacity;
    if (array->type == VALUE_STRING) {
        out->data = array->elements + (size_t)index * (array->capacity + 1u);
        out->type = VALUE_STRING_REF;
    } else {
        out->data = array->elements + (size_t)index * sizeof(int64_t);
        out->type = array->type == VALUE_INTEGER ? VALUE_INTEGER_REF : VALUE_FLOAT_REF;
    }
}

void variables_element(uint16_t variable, const value_t *subscripts, unsigned count, value_t *out) {
    const variables_array_t *array = variables_array(variable);
    if (count != array->dimensions) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    uint32_t index = 0;
    for (unsigned i = count; i-- > 0;) {
        int64_t subscript = value_to_integer(&subscripts[i]);
        if (subscript < array->base) {
            errors_fail(ERR_DIMENSIONS);
        }
        uint64_t place = (uint64_t)subscript - array->base;
        if (place >= array->extent[i]) {
            errors_fail(ERR_INDEX_OUT_OF_BOUNDS);
        }
        index = index * array->extent[i] + (uint32_t)place;
    }
    variables_nth(array, index, out);
}

static uint8_t type_of(const value_t *slot) {
    switch (slot->type) {
    case VALUE_FLOAT_REF:
        return VALUE_FLOAT;
    case VALUE_INTEGER_REF:
        return VALUE_INTEGER;
    case VALUE_STRING_REF:
        return VALUE_STRING;
    case VALUE_ARRAY:
        return ((const variables_array_t *)slot->data)->type;
    default:
        return slot->type;
    }
}

void variables_check_type(uint16_t variable, uint8_t type) {
    value_t *slot = variables_slot(variable);
    if (slot->type == VALUE_NONE) {
        if (!is_local(variable)) {
            symbols_t *symbol = memory_place(variable);
            symbol->type = type;
        }
    } else if (type_of(slot) != type) {
        errors_fail_with(ERR_DIFFERENT_TYPE, "%s", variables_name(variable));
    }
}

size_t variables_size(const variables_array_t *array) {
    uint64_t size = (uint64_t)array->count * variables_element_size(array);
    if (size > SIZE_MAX_OF_ARRAY) {
        errors_fail(ERR_NO_MEMORY);
    }
    return (size_t)size;
}

static uint32_t measure(variables_array_t *array, const value_t *bounds, unsigned dimensions) {
    uint32_t count = 1;
    for (unsigned i = 0; i < dimensions; i++) {
        int64_t upper = value_to_integer(&bounds[i]);
        if (upper < 1 || upper > UPPER_MAX) {
            errors_fail(ERR_DIMENSIONS);
        }
        int64_t extent = upper - vm.base + 1;
        if (count > UINT32_MAX / (uint32_t)extent) {
            errors_fail(ERR_DIMENSIONS);
        }
        array->extent[i] = (uint32_t)extent;
        count *= (uint32_t)extent;
    }
    return count;
}

static void declare_array(uint16_t variable, variables_array_t *shape) {
    variables_array_t *array = allocate(variable, sizeof *array + variables_size(shape));
    uint8_t *elements = (uint8_t *)(array + 1);
    *array = *shape;
    array->elements = elements;
    value_t *slot = variables_slot(variable);
    slot->data = array;
    slot->flags = 0;
    slot->type = VALUE_ARRAY;
}

// A LOCAL met again in a loop starts afresh in the memory it has.
static bool renew_local(const value_t *slot, const variables_array_t *shape) {
    if (slot->type == VALUE_STRING_REF && shape->dimensions == 0 &&
        slot->capacity == shape->capacity && shape->type == VALUE_STRING) {
        *(uint8_t *)slot->data = 0;
        return true;
    }
    if (slot->type == VALUE_ARRAY && shape->dimensions != 0) {
        variables_array_t *array = slot->data;
        if (array->count == shape->count && array->type == shape->type &&
            array->capacity == shape->capacity) {
            memset(array->elements, 0, variables_size(array));
            array->base = shape->base;
            memcpy(array->extent, shape->extent, sizeof array->extent);
            return true;
        }
    }
    return false;
}

void variables_shape(variables_array_t *shape, uint8_t type, unsigned capacity,
                     const value_t *bounds, unsigned dimensions) {
    *shape = (variables_array_t){.dimensions = (uint8_t)dimensions, .base = vm.base};
    shape->type = type;
    shape->capacity = (uint16_t)capacity;
    shape->count = measure(shape, bounds, dimensions);
}

void variables_declare(uint16_t variable, uint8_t type, unsigned capacity, const value_t *bounds,
                       unsigned dimensions) {
    value_t *slot = variables_slot(variable);
    variables_array_t shape;
    variables_shape(&shape, type, capacity, bounds, dimensions);
    if (is_local(variable) && renew_local(slot, &shape)) {
        return;
    }
    if (!is_local(variable) && slot->type != VALUE_NONE) {
        errors_fail_with(ERR_ALREADY_DECLARED, "%s", variables_name(variable));
    }
    if (dimensions == 0) {
        make_scalar(variable, type, capacity);
    } else {
        declare_array(variable, &shape);
    }
}
