// The table of drivers: where each is, what it was set to, how it is. Context: main loop.
#ifndef TMC22XX_DRIVERS_H
#define TMC22XX_DRIVERS_H

#include <stdbool.h>
#include <stdint.h>

#include "tmc22xx/tmc22xx.h"

#define DRIVERS_NONE 0xFFu

// The registers that are kept, in the order in which they are written: those of a set-up first.
enum {
    KEPT_GCONF,
    KEPT_IHOLD_IRUN,
    KEPT_TPOWERDOWN,
    KEPT_CHOPCONF,
    KEPT_PWMCONF,
    KEPT_TPWMTHRS,
    KEPT_TCOOLTHRS,
    KEPT_SGTHRS,
    KEPT_COOLCONF,
    KEPT_COUNT
};
#define KEPT_SET_UP ((1u << KEPT_TPWMTHRS) - 1)
#define KEPT_LATER (((1u << KEPT_COUNT) - 1) & ~KEPT_SET_UP) // 0 after power-up

// What the monitor finds, as bits. The first four come from a register.
enum {
    DRIVERS_HOT = 1,
    DRIVERS_OVERHEATED = 2,
    DRIVERS_SHORT = 4,
    DRIVERS_UNDERVOLTAGE = 8,
    DRIVERS_ERROR = 16, // was off, for one of the reasons above
    DRIVERS_LOST = 32,  // has been reset since it was set up; until it is again
    DRIVERS_SILENT = 64
};

typedef struct {
    uint8_t wire;
    uint8_t address;
    uint8_t chip; // TMC22XX_2208, TMC22XX_2209; 0: free
    uint8_t axis;
    bool listens;
    bool armed;       // TCOOLTHRS in the driver is that for homing
    bool arm_by_user; // arm_tcoolthrs is
    uint8_t ifcnt;
    uint8_t conditions;   // DRIVERS_HOT and so on, as far as is known
    uint8_t told;         // those the user knows of
    uint8_t calm;         // looks in a row without any
    uint8_t answered;     // looks in a row that it has answered, up to a few
    uint16_t dirty;       // kept registers (bits) that may be otherwise in the driver
    uint16_t run_dma;     // 0.1 mA
    uint16_t hold_bp;     // 0.01 %
    uint16_t r_sense_dmo; // 0.1 mOhm
    uint16_t repeats, failures;
    uint32_t arm_tcoolthrs; // 0: none
    uint32_t kept[KEPT_COUNT];
} driver_t;

// NULL: free. Valid until it is replaced.
driver_t *drivers_get(unsigned driver);

// The driver at this address of a wire; DRIVERS_NONE: there is none.
unsigned drivers_at(unsigned wire, uint8_t address);

// A free place in the table; DRIVERS_NONE: there is none.
unsigned drivers_free(void);

void drivers_put(unsigned driver, const driver_t *entry);

// Forgets all on this wire.
void drivers_forget(unsigned wire);

bool drivers_on(unsigned wire);
unsigned drivers_count(void);

// Index among the kept registers; KEPT_COUNT: it is not one.
unsigned drivers_kept(uint8_t reg);
uint8_t drivers_register(unsigned kept);

// The part of `kept` (bits) that this driver's chip has.
uint32_t drivers_has(const driver_t *entry, uint32_t kept);

// What the driver should have in a kept register now.
uint32_t drivers_wanted(const driver_t *entry, unsigned kept);

// Numbers of a set-up into the table's form, and back.
void drivers_note_settings(driver_t *entry, const tmc22xx_settings_t *settings);
void drivers_settings(const driver_t *entry, tmc22xx_settings_t *settings);

// Currents were written as a register: what a change of the current starts from is read off it.
void drivers_note_current(driver_t *entry);

#endif
