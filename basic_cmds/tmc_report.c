// TMC22xx READ, WRITE and PEEK(TMC ...). Context: main loop.
#include "basic_cmds/tmc_report.h"

#include <string.h>

#include "basic_cmds/tmc.h"
#include "tmc22xx/tmc22xx_registers.h"

// ---- Registers ----------------------------------------------------------------------------------

// The register that an argument names, which the driver's chip has to have.
static err_t find_register(const basic_arg_t *arg, const char *name, unsigned driver,
                           const tmc22xx_register_t **found) {
    const basic_text_t *text = &arg->text;
    bool is_word = text->length > 0;
    const tmc22xx_register_t *reg = is_word ? tmc22xx_register(text->text, text->length)
                                            : tmc22xx_register_at((unsigned)arg->integer);
    unsigned chip = tmc22xx_driver(driver)->chip;
    if (reg == NULL && is_word) {
        return err_raise(ERR_ARGUMENT,
                         "%s: %.*s is no register (valid is a name as DRV_STATUS, or "
                         "an address)",
                         name, (int)text->length, text->text);
    }
    if (reg == NULL) {
        return err_raise(ERR_ARGUMENT, "%s: there is none at address %d", name, (int)arg->integer);
    }
    if ((reg->chips & tmc22xx_chip_bit(chip)) == 0) {
        return err_raise(ERR_ARGUMENT, "%s: a TMC%u has no %s", name, chip, reg->name);
    }
    *found = reg;
    return ERR_OK;
}

// The value of a register. What cannot be read is what was written last.
static err_t fetch(unsigned driver, const tmc22xx_register_t *reg, uint32_t *value) {
    if ((reg->access & TMC22XX_READ) == 0) {
        bool known = tmc22xx_written(driver, reg->address, value);
        return known ? ERR_OK : err_raise(ERR_ARGUMENT, "register: %s cannot be read", reg->name);
    }
    err_t err = tmc_finish(tmc22xx_begin_read(driver, &reg->address, 1));
    if (err == ERR_OK) {
        *value = tmc22xx_value(0);
    }
    return err;
}

static void print_field(const tmc22xx_field_t *field, uint32_t value) {
    char number[48];
    size_t length;
    if (field->is_signed) {
        length =
            format_text(number, sizeof number, "%ld", (long)tmc22xx_field_signed(value, field));
    } else {
        length =
            format_text(number, sizeof number, "%lu", (unsigned long)tmc22xx_field(value, field));
    }
    if (field->unit != NULL) {
        format_text(number + length, sizeof number - length, " %s", field->unit);
    }
    basic_printf("  %-18s %-10s %s\n", field->name, number, field->help);
}

static void print_register(const tmc22xx_register_t *reg, uint32_t value, unsigned chip_bit) {
    basic_printf("%s (0x%02X) 0x%08lX%s\n", reg->name, reg->address, (unsigned long)value,
                 reg->access & TMC22XX_READ ? "" : ", as written last");
    for (unsigned i = 0; i < reg->field_count; i++) {
        if (reg->fields[i].chips & chip_bit) {
            print_field(&reg->fields[i], value);
        }
    }
}

err_t tmc_report_read(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    uint32_t value;
    const tmc22xx_register_t *reg;
    err_t err = tmc_begin(&args[0], &args[2], &driver);
    err = err != ERR_OK ? err : find_register(&args[1], "register", driver, &reg);
    if (err != ERR_OK) {
        return err;
    }
    unsigned chip_bit = tmc22xx_chip_bit(tmc22xx_driver(driver)->chip);
    err = fetch(driver, reg, &value);
    if (err == ERR_OK) {
        print_register(reg, value, chip_bit);
    }
    return err;
}

// What a step does to the motor may change at a standstill only.
static err_t check_write(unsigned driver, uint8_t reg, uint32_t value) {
    static const struct {
        uint8_t reg;
        uint32_t mask;
        const char *field;
    } fixed[] = {
        {TMC22XX_REG_CHOPCONF, TMC22XX_MASK(CHOPCONF, MRES), "MRES"},
        {TMC22XX_REG_CHOPCONF, TMC22XX_MASK(CHOPCONF, dedge), "dedge"},
        {TMC22XX_REG_GCONF, TMC22XX_MASK(GCONF, mstep_reg_select), "mstep_reg_select"},
        {TMC22XX_REG_GCONF, TMC22XX_MASK(GCONF, shaft), "shaft"},
    };
    uint32_t now;
    for (size_t i = 0; i < COUNT_OF_ARRAY(fixed); i++) {
        bool changes = fixed[i].reg == reg && tmc22xx_written(driver, reg, &now) &&
                       ((now ^ value) & fixed[i].mask) != 0;
        err_t err = changes ? tmc_check_still(fixed[i].field) : ERR_OK;
        if (err != ERR_OK) {
            return err;
        }
    }
    return ERR_OK;
}

err_t tmc_report_write(const basic_arg_t *args, size_t count) {
    (void)count;
    unsigned driver;
    const tmc22xx_register_t *reg;
    uint32_t value = (uint32_t)args[2].integer;
    err_t err = tmc_begin(&args[0], &args[3], &driver);
    err = err != ERR_OK ? err : find_register(&args[1], "register", driver, &reg);
    err = err != ERR_OK ? err : check_write(driver, reg->address, value);
    if (err != ERR_OK) {
        return err;
    }
    unsigned before = tmc22xx_driver(driver)->microsteps;
    err = tmc_finish(tmc22xx_begin_write(driver, reg->address, value));
    if (err == ERR_OK) {
        tmc_warn_of_scale(driver, before);
    }
    return err;
}

// ---- PEEK ---------------------------------------------------------------------------------------

static uint32_t whole(uint32_t value) {
    return value;
}

static uint32_t current_scale(uint32_t value) {
    return TMC22XX_TAKE(value, DRV_STATUS, CS_ACTUAL);
}

static uint32_t temperature(uint32_t value) {
    return tmc22xx_temperature(value);
}

// What PEEK has a short name for.
static const struct {
    const char *name;
    uint8_t reg;
    uint32_t (*take)(uint32_t value);
} short_names[] = {
    {"SG", TMC22XX_REG_SG_RESULT, whole},
    {"CS", TMC22XX_REG_DRV_STATUS, current_scale},
    {"TEMP", TMC22XX_REG_DRV_STATUS, temperature},
    {"STATUS", TMC22XX_REG_DRV_STATUS, whole},
};

static bool is_word(const basic_text_t *text, const char *word) {
    return text->length == strlen(word) && letters_same(text->text, word, text->length);
}

err_t tmc_report_peek(const basic_arg_t *args, size_t count, basic_value_t *result) {
    (void)count;
    unsigned driver;
    uint32_t value;
    basic_arg_t what = args[1];
    uint32_t (*take)(uint32_t) = whole;
    for (size_t i = 0; i < COUNT_OF_ARRAY(short_names); i++) {
        if (is_word(&args[1].text, short_names[i].name)) {
            what = (basic_arg_t){.integer = short_names[i].reg};
            take = short_names[i].take;
        }
    }
    const tmc22xx_register_t *reg;
    err_t err = tmc_begin(&args[0], &args[2], &driver);
    err = err != ERR_OK ? err : find_register(&what, "what", driver, &reg);
    err = err != ERR_OK ? err : fetch(driver, reg, &value);
    if (err == ERR_OK) {
        *result = (basic_value_t){.type = BASIC_INTEGER, .integer = take(value)};
    }
    return err;
}
