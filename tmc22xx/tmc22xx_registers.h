// The registers of the TMC2208 and TMC2209 with their fields, as one table (registers.def), named
// as in the datasheets: TMC2209 rev. 1.09 and TMC2202/TMC2208/TMC2224 rev. 1.13, chapter 5. It is
// for whoever shows or takes registers by name; who makes or takes apart values in code uses
// TMC22XX_BITS() and TMC22XX_TAKE(). Context: any; everything is constant.
#ifndef TMC22XX_REGISTERS_H
#define TMC22XX_REGISTERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// IOIN.VERSION of the chips.
#define TMC22XX_VERSION_2208 0x20u
#define TMC22XX_VERSION_2209 0x21u

// Access to a register. A register that is neither READ nor CLEAR keeps what was written to itself.
#define TMC22XX_READ 0x01u
#define TMC22XX_WRITE 0x02u
#define TMC22XX_CLEAR 0x04u // a bit is cleared by writing 1 to it

// The chips.
#define TMC22XX_2208 0x01u
#define TMC22XX_2209 0x02u
#define TMC22XX_BOTH (TMC22XX_2208 | TMC22XX_2209)

typedef struct {
    const char *name;
    uint8_t low_bit;
    uint8_t bits;
    bool is_signed;   // two's complement
    uint8_t chips;    // TMC22XX_2208 | TMC22XX_2209: which of them has it
    const char *unit; // NULL: a number without unit, or one of the values that `help` lists
    const char *help;
} tmc22xx_field_t;

typedef struct {
    const char *name;
    uint8_t address;     // 0..0x7F
    uint8_t access;      // TMC22XX_READ | TMC22XX_WRITE | TMC22XX_CLEAR
    uint8_t chips;       // TMC22XX_2208 | TMC22XX_2209: which of them has it
    uint8_t field_count; // of both chips together
    uint32_t reset;      // value after power-up of a chip whose OTP memory is as from the factory
    const tmc22xx_field_t *fields; // from the lowest bit up
    const char *help;
} tmc22xx_register_t;

extern const tmc22xx_register_t tmc22xx_registers[]; // by address
extern const size_t tmc22xx_register_count;

// The register of this name, in any case, or of this address as text ("0x6C", "&H6C", "108").
// SLAVECONF, as older datasheets call it, is NODECONF. NULL: there is none.
const tmc22xx_register_t *tmc22xx_register(const char *name, size_t length);

// The register at this address, NULL: none.
const tmc22xx_register_t *tmc22xx_register_at(unsigned address);

// TMC22XX_2208 of 2208, TMC22XX_2209 of 2209, 0 of anything else.
unsigned tmc22xx_chip_bit(unsigned chip);

// And back, for a chip there is.
unsigned tmc22xx_chip_number(unsigned chip_bit);

// The field's part of a register's value, as it stands there, or with its sign.
uint32_t tmc22xx_field(uint32_t value, const tmc22xx_field_t *field);
int32_t tmc22xx_field_signed(uint32_t value, const tmc22xx_field_t *field);

// Addresses, TMC22XX_REG_GCONF and so on; place and width of the fields, TMC22XX_GCONF_shaft_LOW
// and _SIZE.
enum {
#define REGISTER(name, address, access, chips, reset, help) TMC22XX_REG_##name = (address),
#define FIELD(reg, name, low, size, chips, sign, unit, help)                                       \
    TMC22XX_##reg##_##name##_LOW = (low), TMC22XX_##reg##_##name##_SIZE = (size),
#define END(reg)
#include "tmc22xx/registers.def"
#undef REGISTER
#undef FIELD
#undef END
};

// TMC22XX_MASK(CHOPCONF, MRES): the bits of a field; TMC22XX_BITS(CHOPCONF, MRES, 4): the field as
// 4, what does not fit is cut; TMC22XX_TAKE(value, CHOPCONF, MRES): the field's part of `value`.
#define TMC22XX_MASK(reg, name)                                                                    \
    ((0xFFFFFFFFu >> (32 - TMC22XX_##reg##_##name##_SIZE)) << TMC22XX_##reg##_##name##_LOW)
#define TMC22XX_BITS(reg, name, number)                                                            \
    (((uint32_t)(number) << TMC22XX_##reg##_##name##_LOW) & TMC22XX_MASK(reg, name))
#define TMC22XX_TAKE(value, reg, name)                                                             \
    (((value) & TMC22XX_MASK(reg, name)) >> TMC22XX_##reg##_##name##_LOW)

#endif
