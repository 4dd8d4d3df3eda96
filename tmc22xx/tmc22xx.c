// The face: what is asked for is checked, put into the form of a job and begun. Context: main loop.
#include "tmc22xx/tmc22xx.h"

#include "hal/hal.h"
#include "tmc22xx/drivers.h"
#include "tmc22xx/exchange.h"
#include "tmc22xx/jobs.h"
#include "tmc22xx/monitor.h"
#include "tmc22xx/tmc22xx_registers.h"
#include "tmc22xx/wires.h"

static err_t check_free(void) {
    return tmc22xx_busy() ? err_raise(ERR_TMC_BUSY, NULL) : ERR_OK;
}

// ---- Wires --------------------------------------------------------------------------------------

err_t tmc22xx_wire(uint8_t tx_gpio, uint8_t rx_gpio, uint32_t baud) {
    err_t err = check_free();
    return err != ERR_OK ? err : wires_set(tx_gpio, rx_gpio, baud);
}

static void close(unsigned wire) {
    jobs_cut(wire);
    drivers_forget(wire);
    wires_close(wire);
}

err_t tmc22xx_close(uint8_t tx_gpio) {
    bool any = false;
    for (unsigned i = 0; i < WIRES; i++) {
        const hal_wire_t *wire = wires_get(i);
        if (wire != NULL && (tx_gpio == PINS_NONE || wire->tx_gpio == tx_gpio)) {
            close(i);
            any = true;
        }
    }
    if (any) {
        return ERR_OK;
    }
    return err_raise(ERR_TMC_NOT_INITIALIZED, "no wire%s%s", tx_gpio == PINS_NONE ? "" : " on ",
                     tx_gpio == PINS_NONE ? "" : pins_name(tx_gpio));
}

// ---- Setting up ---------------------------------------------------------------------------------

// What a driver becomes: a new one, or the one that is there with the registers of a set-up.
static void describe(driver_t *entry, const driver_t *before, const tmc22xx_settings_t *settings,
                     const tmc22xx_write_t *writes) {
    uint8_t chip = (uint8_t)tmc22xx_chip_bit(settings->chip);
    uint8_t axis = before != NULL ? before->axis : TMC22XX_NO_AXIS;
    if (before != NULL && before->chip == chip) {
        *entry = *before;
    } else {
        *entry = (driver_t){.chip = chip, .axis = axis};
    }
    entry->address = settings->address;
    for (unsigned i = 0; i < TMC22XX_SETUP_WRITES; i++) {
        entry->kept[drivers_kept(writes[i].address)] = writes[i].value;
    }
    drivers_note_settings(entry, settings);
}

err_t tmc22xx_set_up(const tmc22xx_settings_t *settings) {
    tmc22xx_write_t writes[TMC22XX_SETUP_WRITES];
    err_t err = check_free();
    err = err != ERR_OK ? err : tmc22xx_setup_writes(settings, writes);
    if (err != ERR_OK) {
        return err;
    }
    unsigned wire = wires_find(settings->tx_gpio);
    unsigned driver = wire != WIRES_NONE ? drivers_at(wire, settings->address) : DRIVERS_NONE;
    if (driver == DRIVERS_NONE && drivers_free() == DRIVERS_NONE) {
        return err_raise(ERR_TMC_TOO_MANY, NULL);
    }
    bool opened = wire == WIRES_NONE;
    if (opened) {
        err = wires_set(settings->tx_gpio, settings->tx_gpio, TMC22XX_BAUD);
        if (err != ERR_OK) {
            return err;
        }
        wire = wires_find(settings->tx_gpio);
    }
    driver_t entry;
    describe(&entry, drivers_get(driver), settings, writes);
    entry.wire = (uint8_t)wire;
    jobs_set_up(driver, &entry, opened);
    return ERR_OK;
}

// ---- Changes ------------------------------------------------------------------------------------

// Copies a driver for a change of it. Errors: there is none, or a job is under way.
static err_t copy(unsigned driver, driver_t *entry) {
    const driver_t *now = drivers_get(driver);
    if (now == NULL) {
        return err_raise(ERR_TMC_NOT_INITIALIZED, "no such driver");
    }
    *entry = *now;
    return check_free();
}

err_t tmc22xx_set_current(unsigned driver, double run_ma, double hold_percent) {
    driver_t entry;
    tmc22xx_settings_t settings;
    tmc22xx_current_t current;
    err_t err = copy(driver, &entry);
    if (err == ERR_OK) {
        drivers_settings(&entry, &settings);
        err = tmc22xx_current(run_ma, settings.r_sense_ohm, &current);
    }
    if (err != ERR_OK) {
        return err;
    }
    settings.run_ma = run_ma;
    settings.hold_percent = hold_percent < 0.0 ? settings.hold_percent : hold_percent;
    drivers_note_settings(&entry, &settings);
    uint32_t *ihold_irun = &entry.kept[KEPT_IHOLD_IRUN];
    uint32_t delay = *ihold_irun & TMC22XX_MASK(IHOLD_IRUN, IHOLDDELAY);
    *ihold_irun = (tmc22xx_ihold_irun(&current, settings.hold_percent) &
                   ~TMC22XX_MASK(IHOLD_IRUN, IHOLDDELAY)) |
                  delay;
    uint32_t *chopconf = &entry.kept[KEPT_CHOPCONF];
    bool other_range = (TMC22XX_TAKE(*chopconf, CHOPCONF, vsense) != 0) != current.vsense;
    *chopconf = (*chopconf & ~TMC22XX_MASK(CHOPCONF, vsense)) |
                TMC22XX_BITS(CHOPCONF, vsense, current.vsense);
    jobs_change(driver, &entry, 1u << KEPT_IHOLD_IRUN | (other_range ? 1u << KEPT_CHOPCONF : 0));
    return ERR_OK;
}

static err_t no_register(unsigned chip, const char *name) {
    return err_raise(ERR_TMC_REGISTER, "A TMC%u has no %s", tmc22xx_chip_number(chip), name);
}

// All bits of a register up to its highest field; *is_signed: they are one number with a sign.
static uint32_t width_mask(const tmc22xx_register_t *reg, unsigned chip, bool *is_signed) {
    unsigned bits = 0;
    for (unsigned i = 0; i < reg->field_count; i++) {
        const tmc22xx_field_t *field = &reg->fields[i];
        unsigned end = field->low_bit + field->bits;
        bits = (field->chips & chip) != 0 && end > bits ? end : bits;
    }
    *is_signed = reg->fields[0].is_signed && reg->fields[0].bits == bits;
    return 0xFFFFFFFFu >> (32 - bits);
}

// A negative number may come with all its upper bits set.
static err_t check_value(const tmc22xx_register_t *reg, unsigned chip, uint32_t *value) {
    bool is_signed;
    uint32_t mask = width_mask(reg, chip, &is_signed);
    bool is_negative = is_signed && (*value | mask >> 1) == 0xFFFFFFFFu;
    if (*value > mask && !is_negative) {
        return err_raise(ERR_TMC_REGISTER, "%s takes values up to 0x%X", reg->name, (unsigned)mask);
    }
    *value &= mask;
    return ERR_OK;
}

// Whether the chip has the register, lets it be written, and the value fits.
static err_t check_write(const driver_t *entry, uint8_t address, uint32_t *value) {
    const tmc22xx_register_t *reg = tmc22xx_register_at(address);
    if (reg == NULL) {
        return err_raise(ERR_TMC_REGISTER, "There is no register 0x%02X", address);
    }
    if ((reg->chips & entry->chip) == 0) {
        return no_register(entry->chip, reg->name);
    }
    if ((reg->access & (TMC22XX_WRITE | TMC22XX_CLEAR)) == 0) {
        return err_raise(ERR_TMC_REGISTER, "%s can only be read", reg->name);
    }
    if (address == TMC22XX_REG_OTP_PROG) {
        return err_raise(ERR_TMC_REGISTER, "OTP_PROG cannot be undone and is not written");
    }
    return check_value(reg, entry->chip, value);
}

err_t tmc22xx_begin_write(unsigned driver, uint8_t reg, uint32_t value) {
    driver_t entry;
    err_t err = copy(driver, &entry);
    err = err != ERR_OK ? err : check_write(&entry, reg, &value);
    if (err != ERR_OK) {
        return err;
    }
    unsigned kept = drivers_kept(reg);
    if (kept == KEPT_COUNT) {
        jobs_write(driver, reg, value);
        return ERR_OK;
    }
    entry.kept[kept] = value;
    if (kept == KEPT_IHOLD_IRUN || kept == KEPT_CHOPCONF) {
        drivers_note_current(&entry);
    }
    jobs_change(driver, &entry, 1u << kept);
    return ERR_OK;
}

err_t tmc22xx_set_coolstep(unsigned driver, const tmc22xx_coolstep_t *coolstep) {
    return tmc22xx_begin_write(driver, TMC22XX_REG_COOLCONF,
                               TMC22XX_BITS(COOLCONF, semin, coolstep->semin) |
                                   TMC22XX_BITS(COOLCONF, semax, coolstep->semax) |
                                   TMC22XX_BITS(COOLCONF, seup, coolstep->seup) |
                                   TMC22XX_BITS(COOLCONF, sedn, coolstep->sedn) |
                                   TMC22XX_BITS(COOLCONF, seimin, coolstep->seimin));
}

err_t tmc22xx_set_stealth(unsigned driver, bool on, uint32_t tpwmthrs) {
    driver_t entry;
    err_t err = copy(driver, &entry);
    if (err != ERR_OK) {
        return err;
    }
    uint32_t *gconf = &entry.kept[KEPT_GCONF];
    *gconf =
        (*gconf & ~TMC22XX_MASK(GCONF, en_SpreadCycle)) | TMC22XX_BITS(GCONF, en_SpreadCycle, !on);
    entry.kept[KEPT_TPWMTHRS] = tpwmthrs;
    jobs_change(driver, &entry, 1u << KEPT_GCONF | 1u << KEPT_TPWMTHRS);
    return ERR_OK;
}

// ---- Other jobs ---------------------------------------------------------------------------------

static err_t check_read(unsigned chip, uint8_t address) {
    const tmc22xx_register_t *reg = tmc22xx_register_at(address);
    if (reg == NULL) {
        return err_raise(ERR_TMC_REGISTER, "There is no register 0x%02X", address);
    }
    if ((reg->chips & chip) == 0) {
        return no_register(chip, reg->name);
    }
    if ((reg->access & TMC22XX_READ) == 0) {
        return err_raise(ERR_TMC_REGISTER, "%s can only be written", reg->name);
    }
    return ERR_OK;
}

err_t tmc22xx_begin_read(unsigned driver, const uint8_t *registers, size_t count) {
    driver_t entry;
    err_t err = copy(driver, &entry);
    for (size_t i = 0; err == ERR_OK && i < count; i++) {
        err = check_read(entry.chip, registers[i]);
    }
    if (err == ERR_OK) {
        jobs_read(driver, registers, count < TMC22XX_READS ? count : TMC22XX_READS);
    }
    return err;
}

err_t tmc22xx_begin_arm(uint32_t drivers, bool on) {
    err_t err = check_free();
    if (err == ERR_OK) {
        jobs_arm(drivers, on);
    }
    return err;
}

// ---- Background ---------------------------------------------------------------------------------

void tmc22xx_background(void) {
    if (tmc22xx_busy()) {
        jobs_step();
        return;
    }
    unsigned driver = monitor_take_turn();
    if (driver != DRIVERS_NONE) {
        jobs_look_after(driver);
        jobs_step();
    }
}

uint64_t tmc22xx_wake_us(void) {
    if (tmc22xx_busy()) {
        return exchange_wake_us();
    }
    return monitor_is_due() ? 0 : UINT64_MAX;
}
