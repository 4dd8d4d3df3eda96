// One variable as it is saved. Context: main loop.
#ifndef BASIC_SAVED_RECORD_H
#define BASIC_SAVED_RECORD_H

#include <stdint.h>

#include "symbols.h"
#include "variables.h"

typedef struct {
    uint32_t size;  // of the values behind it, bytes
    uint16_t check; // SAVED_RECORD_CHECK; 0 in the record that ends the file
    uint8_t type;   // VALUE_FLOAT, _INTEGER or _STRING
    uint8_t dimensions;
    uint8_t base;
    uint8_t capacity; // of a string, bytes
    uint8_t name_length;
    char name[SYMBOLS_NAME_MAX + 1];
    uint32_t extent[VARIABLES_DIMENSIONS_MAX];
} saved_record_t;

#define SAVED_RECORD_CHECK 0x5653u

// Describes a variable, whose bytes are at *values. Errors: it does not exist, is a constant.
void saved_record_describe(const symbols_t *symbol, saved_record_t *record, const void **values);

// The variable of that name, type and shape, made if there is none; its bytes are at *values.
// Errors: another type or shape, not enough memory.
void saved_record_find(const saved_record_t *record, void **values);

// False: no description that saved_record_describe() can have made.
bool saved_record_is_sound(const saved_record_t *record);

#endif
