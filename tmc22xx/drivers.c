// The table of drivers and what can be read off it. Context: main loop.
#include "tmc22xx/drivers.h"

#include <string.h>

#include "hal/pins.h"
#include "tmc22xx/tmc22xx_registers.h"
#include "tmc22xx/wires.h"

static driver_t drivers[TMC22XX_DRIVERS];
static uint8_t count;

static const uint8_t kept_registers[KEPT_COUNT] = {
    [KEPT_GCONF] = TMC22XX_REG_GCONF,           [KEPT_IHOLD_IRUN] = TMC22XX_REG_IHOLD_IRUN,
    [KEPT_TPOWERDOWN] = TMC22XX_REG_TPOWERDOWN, [KEPT_CHOPCONF] = TMC22XX_REG_CHOPCONF,
    [KEPT_PWMCONF] = TMC22XX_REG_PWMCONF,       [KEPT_TPWMTHRS] = TMC22XX_REG_TPWMTHRS,
    [KEPT_TCOOLTHRS] = TMC22XX_REG_TCOOLTHRS,   [KEPT_SGTHRS] = TMC22XX_REG_SGTHRS,
    [KEPT_COOLCONF] = TMC22XX_REG_COOLCONF,
};

// ---- Places -------------------------------------------------------------------------------------

driver_t *drivers_get(unsigned driver) {
    return driver < TMC22XX_DRIVERS && drivers[driver].chip != 0 ? &drivers[driver] : NULL;
}

unsigned drivers_at(unsigned wire, uint8_t address) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if (drivers[i].chip != 0 && drivers[i].wire == wire && drivers[i].address == address) {
            return i;
        }
    }
    return DRIVERS_NONE;
}

unsigned drivers_free(void) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if (drivers[i].chip == 0) {
            return i;
        }
    }
    return DRIVERS_NONE;
}

void drivers_put(unsigned driver, const driver_t *entry) {
    count = (uint8_t)(count + (drivers[driver].chip == 0));
    drivers[driver] = *entry;
}

unsigned drivers_count(void) {
    return count;
}

void drivers_forget(unsigned wire) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if (drivers[i].chip != 0 && drivers[i].wire == wire) {
            drivers[i].chip = 0;
            count--;
        }
    }
}

bool drivers_on(unsigned wire) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if (drivers[i].chip != 0 && drivers[i].wire == wire) {
            return true;
        }
    }
    return false;
}

// ---- Kept registers -----------------------------------------------------------------------------

unsigned drivers_kept(uint8_t reg) {
    unsigned kept = 0;
    while (kept < KEPT_COUNT && kept_registers[kept] != reg) {
        kept++;
    }
    return kept;
}

uint8_t drivers_register(unsigned kept) {
    return kept_registers[kept];
}

uint32_t drivers_has(const driver_t *entry, uint32_t kept) {
    for (unsigned i = 0; i < KEPT_COUNT; i++) {
        const tmc22xx_register_t *reg = tmc22xx_register_at(kept_registers[i]);
        if ((reg->chips & entry->chip) == 0) {
            kept &= ~(1u << i);
        }
    }
    return kept;
}

uint32_t drivers_wanted(const driver_t *entry, unsigned kept) {
    bool homing = kept == KEPT_TCOOLTHRS && entry->armed;
    if (!homing || (entry->kept[kept] != 0 && !entry->arm_by_user)) {
        return entry->kept[kept];
    }
    return entry->arm_tcoolthrs;
}

// ---- Settings -----------------------------------------------------------------------------------

static uint16_t rounded(double number) {
    return (uint16_t)(number + 0.5);
}

void drivers_note_settings(driver_t *entry, const tmc22xx_settings_t *settings) {
    entry->run_dma = rounded(settings->run_ma * 10.0);
    entry->hold_bp = rounded(settings->hold_percent * 100.0);
    entry->r_sense_dmo = rounded(settings->r_sense_ohm * 10000.0);
}

void drivers_settings(const driver_t *entry, tmc22xx_settings_t *settings) {
    *settings = (tmc22xx_settings_t){
        .tx_gpio = wires_get(entry->wire)->tx_gpio,
        .address = entry->address,
        .chip = (uint16_t)tmc22xx_chip_number(entry->chip),
        .run_ma = entry->run_dma / 10.0,
        .hold_percent = entry->hold_bp / 100.0,
        .microsteps =
            (uint16_t)tmc22xx_microsteps(TMC22XX_TAKE(entry->kept[KEPT_CHOPCONF], CHOPCONF, MRES)),
        .r_sense_ohm = entry->r_sense_dmo / 10000.0,
        .stealth = TMC22XX_TAKE(entry->kept[KEPT_GCONF], GCONF, en_SpreadCycle) == 0,
    };
}

static double scale_ma(const driver_t *entry, uint32_t scale) {
    bool vsense = TMC22XX_TAKE(entry->kept[KEPT_CHOPCONF], CHOPCONF, vsense) != 0;
    return tmc22xx_scale_ma(scale, vsense, entry->r_sense_dmo / 10000.0);
}

void drivers_note_current(driver_t *entry) {
    uint32_t ihold_irun = entry->kept[KEPT_IHOLD_IRUN];
    uint32_t run = TMC22XX_TAKE(ihold_irun, IHOLD_IRUN, IRUN);
    uint32_t hold = TMC22XX_TAKE(ihold_irun, IHOLD_IRUN, IHOLD);
    double percent = run == 0 ? 100.0 : 100.0 * hold / run;
    entry->run_dma = rounded(scale_ma(entry, run) * 10.0);
    entry->hold_bp = rounded((percent < 100.0 ? percent : 100.0) * 100.0);
}

// ---- The face -----------------------------------------------------------------------------------

static bool is_at(unsigned driver, unsigned address, uint8_t tx_gpio) {
    const driver_t *entry = &drivers[driver];
    return entry->chip != 0 && entry->address == address &&
           (tx_gpio == PINS_NONE || wires_get(entry->wire)->tx_gpio == tx_gpio);
}

static err_t find_second(unsigned address, unsigned driver) {
    for (unsigned i = driver + 1; i < TMC22XX_DRIVERS; i++) {
        if (is_at(i, address, PINS_NONE)) {
            return err_raise(ERR_TMC_SEVERAL, "%u is on %s and on %s", address,
                             pins_name(wires_get(drivers[driver].wire)->tx_gpio),
                             pins_name(wires_get(drivers[i].wire)->tx_gpio));
        }
    }
    return ERR_OK;
}

err_t tmc22xx_find(unsigned address, uint8_t tx_gpio, unsigned *driver) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if (is_at(i, address, tx_gpio)) {
            *driver = i;
            return tx_gpio != PINS_NONE ? ERR_OK : find_second(address, i);
        }
    }
    bool on_any = tx_gpio == PINS_NONE;
    return err_raise(ERR_TMC_NOT_INITIALIZED, "no driver at address %u%s%s", address,
                     on_any ? "" : " on ", on_any ? "" : pins_name(tx_gpio));
}

err_t tmc22xx_find_axis(unsigned axis, unsigned *driver) {
    for (unsigned i = 0; i < TMC22XX_DRIVERS; i++) {
        if (drivers[i].chip != 0 && drivers[i].axis == axis) {
            *driver = i;
            return ERR_OK;
        }
    }
    return err_raise(ERR_TMC_NOT_INITIALIZED, "no driver is tied to axis %c, use TMC22xx AXIS",
                     "XYZA"[axis % 4]);
}

void tmc22xx_tie(unsigned driver, unsigned axis) {
    driver_t *entry = drivers_get(driver);
    if (entry != NULL) {
        entry->axis = (uint8_t)axis;
    }
}

const tmc22xx_settings_t *tmc22xx_driver(unsigned driver) {
    static tmc22xx_settings_t settings;
    const driver_t *entry = drivers_get(driver);
    if (entry == NULL) {
        return NULL;
    }
    drivers_settings(entry, &settings);
    return &settings;
}

bool tmc22xx_info(unsigned driver, tmc22xx_info_t *info) {
    const driver_t *entry = drivers_get(driver);
    if (entry == NULL) {
        return false;
    }
    const hal_wire_t *wire = wires_get(entry->wire);
    uint32_t ihold_irun = entry->kept[KEPT_IHOLD_IRUN];
    *info = (tmc22xx_info_t){
        .axis = entry->axis,
        .listens = entry->listens,
        .armed = entry->armed || (entry->dirty & 1u << KEPT_TCOOLTHRS) != 0,
        .lost = (entry->conditions & DRIVERS_LOST) != 0,
        .rx_gpio = wire->rx_gpio,
        .baud = wire->baud,
        .irun = (uint8_t)TMC22XX_TAKE(ihold_irun, IHOLD_IRUN, IRUN),
        .ihold = (uint8_t)TMC22XX_TAKE(ihold_irun, IHOLD_IRUN, IHOLD),
        .vsense = TMC22XX_TAKE(entry->kept[KEPT_CHOPCONF], CHOPCONF, vsense) != 0,
        .tpwmthrs = entry->kept[KEPT_TPWMTHRS],
        .tcoolthrs = entry->kept[KEPT_TCOOLTHRS],
        .sgthrs = (uint8_t)entry->kept[KEPT_SGTHRS],
        .kept_tcoolthrs = entry->arm_by_user ? entry->arm_tcoolthrs : 0,
        .ifcnt = entry->ifcnt,
        .repeats = entry->repeats,
        .failures = entry->failures,
    };
    info->run_ma = scale_ma(entry, info->irun);
    info->hold_ma = scale_ma(entry, info->ihold);
    return true;
}

bool tmc22xx_written(unsigned driver, uint8_t reg, uint32_t *value) {
    const driver_t *entry = drivers_get(driver);
    unsigned kept = drivers_kept(reg);
    if (entry == NULL || kept == KEPT_COUNT) {
        return false;
    }
    *value = entry->kept[kept];
    return true;
}

void tmc22xx_keep_threshold(unsigned driver, uint32_t tcoolthrs, bool by_user) {
    driver_t *entry = drivers_get(driver);
    if (entry == NULL || (entry->arm_by_user && !by_user)) {
        return;
    }
    entry->arm_tcoolthrs = tcoolthrs;
    entry->arm_by_user = by_user && tcoolthrs != 0;
}
