// Prints docs/tmc22xx-registers.md from the table of registers. Built for the host; `make
// reference` writes the page and a test compares it. Context: a program of its own.
#include <stdio.h>

#include "base/base.h"
#include "tmc22xx/tmc22xx_registers.h"

static const char *access_of(const tmc22xx_register_t *reg) {
    switch (reg->access) {
    case TMC22XX_READ:
        return "read";
    case TMC22XX_WRITE:
        return "write";
    case TMC22XX_READ | TMC22XX_CLEAR:
        return "read, clear";
    default:
        return "read, write";
    }
}

static const char *chips_of(unsigned chips) {
    return chips == TMC22XX_BOTH ? "both" : chips == TMC22XX_2209 ? "TMC2209" : "TMC2208";
}

// What the chip measures has no value after power-up.
static void print_reset(const tmc22xx_register_t *reg) {
    if (reg->access == TMC22XX_READ) {
        printf("-");
    } else {
        printf("0x%08X", (unsigned)reg->reset);
    }
}

static void print_overview(void) {
    printf("| address | register | access | chips | after power-up | what |\n"
           "| --- | --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < tmc22xx_register_count; i++) {
        const tmc22xx_register_t *reg = &tmc22xx_registers[i];
        printf("| 0x%02X | [%s](#", reg->address, reg->name);
        for (const char *p = reg->name; *p != '\0'; p++) {
            printf("%c", letters_lower(*p));
        }
        printf(") | %s | %s | ", access_of(reg), chips_of(reg->chips));
        print_reset(reg);
        printf(" | %s |\n", reg->help);
    }
    printf("\n");
}

static void print_bits(const tmc22xx_field_t *field) {
    if (field->bits == 1) {
        printf("%u", field->low_bit);
    } else {
        printf("%u..%u", field->low_bit + field->bits - 1u, field->low_bit);
    }
}

static void print_range(const tmc22xx_field_t *field) {
    long long span = 1LL << field->bits;
    if (field->is_signed) {
        printf("%lld to %lld", -span / 2, span / 2 - 1);
    } else {
        printf("0 to %lld", span - 1);
    }
    printf("%s%s", field->unit != NULL ? " " : "", field->unit != NULL ? field->unit : "");
}

static void print_register(const tmc22xx_register_t *reg) {
    printf("## %s\n\n0x%02X, %s: %s.\n\n| bits | field | values | what |\n"
           "| --- | --- | --- | --- |\n",
           reg->name, reg->address, access_of(reg), reg->help);
    for (unsigned i = 0; i < reg->field_count; i++) {
        const tmc22xx_field_t *field = &reg->fields[i];
        printf("| ");
        print_bits(field);
        printf(" | %s | ", field->name);
        print_range(field);
        printf(" | %s%s%s |\n", field->help, field->chips != TMC22XX_BOTH ? " - only " : "",
               field->chips != TMC22XX_BOTH ? chips_of(field->chips) : "");
    }
    printf("\n");
}

int main(void) {
    printf("# Registers of the TMC2208 and TMC2209\n\n"
           "Made from the firmware's own table. `TMC22xx READ` shows a register with its fields, "
           "`TMC22xx WRITE` writes one, and\n"
           "`PEEK(TMC ...)` knows the same names. Names and bits are those of the makers' "
           "datasheets (TMC2209 rev. 1.09,\n"
           "TMC2202/TMC2208/TMC2224 rev. 1.13), where all is told at length. Times and speeds are "
           "those of the internal clock of\n"
           "12 MHz. The values after power-up are the published ones; a chip's OTP memory may say "
           "otherwise.\n\n");
    print_overview();
    for (size_t i = 0; i < tmc22xx_register_count; i++) {
        print_register(&tmc22xx_registers[i]);
    }
    return 0;
}
