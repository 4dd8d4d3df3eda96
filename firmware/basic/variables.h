// Variables and arrays at run time, named by handle (see code.h). Context: main loop.
#ifndef BASIC_VARIABLES_H
#define BASIC_VARIABLES_H

#include <stdbool.h>
#include <stdint.h>

#include "code.h"
#include "memory.h"
#include "vm.h"

#define VARIABLES_DIMENSIONS_MAX 6
#define VARIABLES_NAME_SIZE 36

typedef struct {
    uint8_t dimensions;
    uint8_t type;                              // VALUE_FLOAT, _INTEGER or _STRING
    uint8_t base;                              // lowest subscript
    uint16_t capacity;                         // of a string
    uint32_t count;                            // elements
    uint32_t extent[VARIABLES_DIMENSIONS_MAX]; // elements along each dimension
    uint8_t *elements;                         // the first subscript runs fastest
} variables_array_t;

static inline value_t *variables_slot(uint16_t variable) {
    if (variable & CODE_LOCAL_FLAG) {
        return vm.locals + (variable & ~CODE_LOCAL_FLAG);
    }
    return memory_place(variable);
}

// Makes a variable on first use, with the type its name says or OPTION DEFAULT.
// Error: OPTION EXPLICIT is on.
void variables_create(uint16_t variable);

// Assigns. Errors: wrong type, a constant, string too long.
void variables_store(uint16_t variable, const value_t *value);

// A reference to a variable (or an array) for an argument; to a constant only its value.
void variables_reference(uint16_t variable, bool array, value_t *out);

// A reference to an element. Errors: as MMBasic's for subscripts.
void variables_element(uint16_t variable, const value_t *subscripts, unsigned count, value_t *out);

// The `index`th element in the order of memory. Error: index out of bounds.
void variables_nth(const variables_array_t *array, uint32_t index, value_t *out);

// The array a variable is; error if it is none.
variables_array_t *variables_array(uint16_t variable);

// The variable has this type, or does not exist yet and gets it. Error: another type.
void variables_check_type(uint16_t variable, uint8_t type);

// Bytes of one element, and of all. Error: not enough memory.
static inline unsigned variables_element_size(const variables_array_t *array) {
    return array->type == VALUE_STRING ? array->capacity + 1u : (unsigned)sizeof(int64_t);
}
size_t variables_size(const variables_array_t *array);

// Fills in what an array with these bounds is, all but its elements. Error: dimensions.
void variables_shape(variables_array_t *shape, uint8_t type, unsigned capacity,
                     const value_t *bounds, unsigned dimensions);

// Declares: a scalar (dimensions == 0) or an array; `capacity` is that of strings.
// Errors: array size, not enough memory.
void variables_declare(uint16_t variable, uint8_t type, unsigned capacity, const value_t *bounds,
                       unsigned dimensions);

// Gives `place` an empty string of the hidden variable's own. In text compiled while a program
// runs, and at the prompt, it lives no longer than the code.
void variables_make_hidden_string(uint16_t variable, value_t *place);

// The name in capitals for an error message.
const char *variables_name(uint16_t variable);

#endif
