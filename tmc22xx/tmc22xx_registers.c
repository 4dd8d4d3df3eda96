// The table of registers from registers.def, and looking things up in it. Context: any.
#include "tmc22xx/tmc22xx_registers.h"

#include <string.h>

#include "base/base.h"

// Where each register's fields begin in `fields`: a register takes the number of its first field,
// and BEFORE makes the next one begin there again.
enum {
#define REGISTER(name, address, access, chips, reset, help)                                        \
    FIRST_##name, BEFORE_##name = FIRST_##name - 1,
#define FIELD(reg, name, low, size, chips, sign, unit, help) AT_##reg##_##name,
#define END(reg) BEHIND_##reg, BACK_##reg = BEHIND_##reg - 1,
#include "tmc22xx/registers.def"
#undef REGISTER
#undef FIELD
#undef END
};

static const tmc22xx_field_t fields[] = {
#define REGISTER(name, address, access, chips, reset, help)
#define FIELD(reg, name, low, size, chips, sign, unit, help)                                       \
    {#name, (low), (size), (sign), (chips), (unit), (help)},
#define END(reg)
#include "tmc22xx/registers.def"
#undef REGISTER
#undef FIELD
#undef END
};

const tmc22xx_register_t tmc22xx_registers[] = {
#define REGISTER(name, address, access, chips, reset, help)                                        \
    {#name,                                                                                        \
     (address),                                                                                    \
     (access),                                                                                     \
     (chips),                                                                                      \
     BEHIND_##name - FIRST_##name,                                                                 \
     (reset),                                                                                      \
     &fields[FIRST_##name],                                                                        \
     (help)},
#define FIELD(reg, name, low, size, chips, sign, unit, help)
#define END(reg)
#include "tmc22xx/registers.def"
#undef REGISTER
#undef FIELD
#undef END
};

const size_t tmc22xx_register_count = COUNT_OF_ARRAY(tmc22xx_registers);

const tmc22xx_register_t *tmc22xx_register_at(unsigned address) {
    for (size_t i = 0; i < tmc22xx_register_count; i++) {
        if (tmc22xx_registers[i].address == address) {
            return &tmc22xx_registers[i];
        }
    }
    return NULL;
}

static unsigned digit_of(char c) {
    char upper = letters_upper(c);
    if (upper >= '0' && upper <= '9') {
        return (unsigned)(upper - '0');
    }
    return upper >= 'A' && upper <= 'F' ? (unsigned)(upper - 'A') + 10 : 16;
}

// The register whose address is written here, in decimal or with 0x or &H before it.
static const tmc22xx_register_t *of_number(const char *text, size_t length) {
    bool prefixed = length > 2 && (letters_same(text, "0x", 2) || letters_same(text, "&H", 2));
    unsigned base = prefixed ? 16 : 10;
    size_t at = prefixed ? 2 : 0;
    unsigned address = 0;
    if (length == 0 || length - at > 4) {
        return NULL;
    }
    for (; at < length; at++) {
        unsigned digit = digit_of(text[at]);
        if (digit >= base) {
            return NULL;
        }
        address = address * base + digit;
    }
    return tmc22xx_register_at(address);
}

static bool is_name(const char *name, const char *text, size_t length) {
    return strlen(name) == length && letters_same(name, text, length);
}

const tmc22xx_register_t *tmc22xx_register(const char *name, size_t length) {
    for (size_t i = 0; i < tmc22xx_register_count; i++) {
        if (is_name(tmc22xx_registers[i].name, name, length)) {
            return &tmc22xx_registers[i];
        }
    }
    if (is_name("SLAVECONF", name, length)) {
        return tmc22xx_register_at(TMC22XX_REG_NODECONF);
    }
    return of_number(name, length);
}

unsigned tmc22xx_chip_bit(unsigned chip) {
    return chip == 2208 ? TMC22XX_2208 : chip == 2209 ? TMC22XX_2209 : 0;
}

unsigned tmc22xx_chip_number(unsigned chip_bit) {
    return chip_bit == TMC22XX_2208 ? 2208 : 2209;
}

uint32_t tmc22xx_field(uint32_t value, const tmc22xx_field_t *field) {
    return (value >> field->low_bit) & (0xFFFFFFFFu >> (32 - field->bits));
}

int32_t tmc22xx_field_signed(uint32_t value, const tmc22xx_field_t *field) {
    uint32_t part = tmc22xx_field(value, field);
    uint32_t sign = field->is_signed ? 1u << (field->bits - 1) : 0;
    return (int32_t)((part ^ sign) - sign);
}
