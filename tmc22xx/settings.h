// What a user sets about a driver, as registers, and registers as what a user wants to know:
// current in mA, microsteps, speeds. Passed on by tmc22xx.h. Values and formulas: datasheet TMC2209
// rev. 1.09, sections 5.2, 5.5 and 9; the registers of a set-up are those of the PicoMite firmware,
// to the bit. Context: main loop.
#ifndef TMC22XX_SETTINGS_H
#define TMC22XX_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

#define TMC22XX_CLOCK_HZ 12000000u // internal clock, as the maker trims it
#define TMC22XX_TSTEP_MAX 0xFFFFFu // TSTEP at standstill, and the highest threshold
#define TMC22XX_R_SENSE_MIN_OHM 0.08
#define TMC22XX_R_SENSE_MAX_OHM 0.2
#define TMC22XX_R_SENSE_OHM 0.11 // of most modules
#define TMC22XX_RUN_MA_MAX 2000

typedef struct {
    uint8_t tx_gpio; // names the wire
    uint8_t address; // 0..3; of a TMC2208 always 0
    uint16_t chip;   // 2208, 2209
    double run_ma;   // effective value (RMS), above 0
    double hold_percent;
    uint16_t microsteps; // 1, 2, 4 .. 256
    double r_sense_ohm;
    bool stealth; // StealthChop, else SpreadCycle
} tmc22xx_settings_t;

// A current as the chip can have it.
typedef struct {
    uint8_t scale;  // IRUN: 0..31
    bool vsense;    // the low range: 180 mV at the sense resistor instead of 325 mV
    bool limited;   // more was asked for than the range gives
    double real_ma; // effective value that comes of it
} tmc22xx_current_t;

// One write of a register.
typedef struct {
    uint8_t address;
    uint32_t value;
} tmc22xx_write_t;

// The nearest current the chip can have. Below half the smallest: ERR_TMC_CURRENT, which names the
// smallest; above the largest: the largest, and `limited`.
err_t tmc22xx_current(double ma, double r_sense_ohm, tmc22xx_current_t *current);

// Effective value of a current scale (IRUN, IHOLD, CS_ACTUAL) in mA.
double tmc22xx_scale_ma(unsigned scale, bool vsense, double r_sense_ohm);

// What a set-up writes, in this order: GCONF, IHOLD_IRUN, TPOWERDOWN, CHOPCONF, PWMCONF.
// Errors: ERR_TMC_CHIP, ERR_TMC_ADDRESS, ERR_TMC_MICROSTEPS, ERR_TMC_CURRENT, ERR_ARGUMENT for the
// rest; nothing is set then.
#define TMC22XX_SETUP_WRITES 5
err_t tmc22xx_setup_writes(const tmc22xx_settings_t *settings,
                           tmc22xx_write_t writes[TMC22XX_SETUP_WRITES]);

// IHOLD_IRUN for a current and its share at standstill; the rest of a set-up's value with it.
uint32_t tmc22xx_ihold_irun(const tmc22xx_current_t *current, double hold_percent);

// MRES for 1, 2, 4 .. 256 microsteps, -1 for any other number; and back, 0 for what is no MRES.
int tmc22xx_mres(unsigned microsteps);
unsigned tmc22xx_microsteps(unsigned mres);

// TSTEP (clocks of a 1/256 microstep, rounded, 1..TMC22XX_TSTEP_MAX) at a speed in steps/s of so
// many microsteps, and back: the speed above which TSTEP is below this value. 0 steps/s is
// standstill.
uint32_t tmc22xx_tstep(double steps_per_s, unsigned microsteps);
double tmc22xx_steps_per_s(uint32_t tstep, unsigned microsteps);

#endif
