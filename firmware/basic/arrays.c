// ERASE and REDIM. Memory is given back only if nothing on the stack refers to it: an argument by
// reference may name an element, or the whole array, of a routine further out. Context: main loop.
#include "arrays.h"

#include <string.h>

#include "calls.h"
#include "errors.h"
#include "memory.h"
#include "symbols.h"
#include "variables.h"
#include "vm.h"

_Static_assert(sizeof(variables_array_t) % 8 == 0, "the elements behind it are given back apart");

static bool in_heap(const void *place) {
    return (const uint8_t *)place < memory.heap;
}

// Error if a reference on the stack, other than `own`, leads into these bytes.
static void refuse_if_in_use(const void *bytes, size_t size, const value_t *own) {
    const uint8_t *start = bytes;
    for (const value_t *value = memory.values; value < vm.operands; value++) {
        const uint8_t *data = value->data;
        bool reference = value->type >= VALUE_FLOAT_REF && value->type <= VALUE_ARRAY;
        if (reference && value != own && data >= start && data < start + size) {
            errors_fail(ERR_ARRAY_IN_USE);
        }
    }
}

// ---- ERASE --------------------------------------------------------------------------------------

static void release_array(value_t *slot) {
    variables_array_t *array = slot->data;
    size_t size = variables_size(array);
    refuse_if_in_use(array, sizeof *array, slot);
    refuse_if_in_use(array->elements, size, slot);
    if (in_heap(array)) {
        memory_release(array->elements, size);
        memory_release(array, sizeof *array);
    }
}

void arrays_erase(uint16_t variable) {
    value_t *slot = variables_slot(variable);
    bool is_local = (variable & CODE_LOCAL_FLAG) != 0;
    if (slot->type == VALUE_NONE) {
        errors_fail_with(ERR_NOT_DECLARED, "%s", variables_name(variable));
    }
    if (!is_local && slot->type == VALUE_ARRAY) {
        release_array(slot);
    } else if (!is_local && slot->type == VALUE_STRING_REF) {
        refuse_if_in_use(slot->data, slot->capacity + 1u, slot);
        memory_release(slot->data, slot->capacity + 1u);
    } else {
        refuse_if_in_use(slot, sizeof *slot, slot);
    }
    *slot = (value_t){.type = VALUE_NONE}; // what was a local's goes at the end of its routine
}

static void erase_symbol(symbols_t *symbol) {
    if (symbol->value.type != VALUE_NONE) {
        arrays_erase(memory_handle(symbol));
    }
}

void arrays_erase_all(void) {
    if (calls_routine() != NULL) {
        errors_fail(ERR_INVALID_HERE);
    }
    symbols_each_of(SYMBOLS_VARIABLE, erase_symbol);
}

// ---- REDIM --------------------------------------------------------------------------------------

// The array was made since the routine that runs was entered, and not outside an EXECUTE around us.
static bool is_of_this_call(const variables_array_t *array) {
    for (unsigned i = vm.depth; i-- > 0;) {
        if (vm.frames[i].routine != NULL) {
            return (const uint8_t *)array < vm.frames[i].scratch;
        }
    }
    return false;
}

// Memory that lives as long as the array.
static uint8_t *new_elements(const variables_array_t *array, size_t size) {
    if (in_heap(array)) {
        return memory_heap(size);
    }
    if (!is_of_this_call(array)) {
        errors_fail(ERR_NOT_THIS_ARRAY);
    }
    uint8_t *place = memory_scratch(size);
    vm.scratch_base = memory.scratch;
    return place;
}

// Copies what both shapes have, one run along the first dimension after the other.
static void copy_shared(const variables_array_t *from, const variables_array_t *to) {
    uint32_t at[VARIABLES_DIMENSIONS_MAX] = {0};
    unsigned size = variables_element_size(from);
    uint32_t run = from->extent[0] < to->extent[0] ? from->extent[0] : to->extent[0];
    unsigned dimension;
    do {
        size_t source = 0, target = 0;
        for (unsigned i = from->dimensions; i-- > 1;) {
            source = (source + at[i]) * from->extent[i - 1];
            target = (target + at[i]) * to->extent[i - 1];
        }
        memcpy(to->elements + target * size, from->elements + source * size, (size_t)run * size);
        for (dimension = 1; dimension < from->dimensions; dimension++) {
            if (++at[dimension] < from->extent[dimension] &&
                at[dimension] < to->extent[dimension]) {
                break;
            }
            at[dimension] = 0;
        }
    } while (dimension < from->dimensions);
}

static void check_type(uint16_t variable, const variables_array_t *array, uint8_t type) {
    if (type != VALUE_NONE && type != array->type) {
        errors_fail_with(ERR_DIFFERENT_TYPE, "%s", variables_name(variable));
    }
}

void arrays_redim(uint16_t variable, uint8_t type, unsigned capacity, const value_t *bounds,
                  unsigned dimensions, bool preserve) {
    variables_array_t *array = variables_array(variable);
    variables_array_t shape;
    check_type(variable, array, type);
    variables_shape(&shape, array->type, capacity != 0 ? capacity : array->capacity, bounds,
                    dimensions);
    bool same_kind = dimensions == array->dimensions && shape.capacity == array->capacity &&
                     shape.base == array->base;
    if (preserve && !same_kind) {
        errors_fail(ERR_ARRAY_DIMENSIONS);
    }
    size_t old_size = variables_size(array);
    refuse_if_in_use(array->elements, old_size, NULL);
    uint8_t *old = array->elements;
    shape.elements = new_elements(array, variables_size(&shape));
    if (preserve) {
        copy_shared(array, &shape);
    }
    *array = shape;
    if (in_heap(array)) {
        memory_release(old, old_size);
    }
}
