// What status registers say, in plain words: a table of conditions, each of which is some bits of
// a register having certain values. Passed on by tmc22xx.h. Source: datasheet TMC2209 rev. 1.09,
// sections 5.1, 5.5.3 and 14. Context: any; everything is constant.
#ifndef TMC22XX_STATUS_H
#define TMC22XX_STATUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    TMC22XX_STATE,   // just so
    TMC22XX_HINT,    // may mean something
    TMC22XX_WARNING, // the motor runs, but not for long
    TMC22XX_FAULT    // the motor is off, or does not do what was set
} tmc22xx_severity_t;

typedef struct {
    uint8_t reg;      // GSTAT, IOIN or DRV_STATUS
    uint8_t severity; // tmc22xx_severity_t
    uint32_t mask;    // it holds if these bits ...
    uint32_t match;   // ... have this value
    const char *text; // "motor coil A: short to ground"
} tmc22xx_condition_t;

#define TMC22XX_CONDITIONS_MAX 32 // they fit a word

extern const tmc22xx_condition_t tmc22xx_conditions[]; // of each register the gravest first
extern const size_t tmc22xx_condition_count;

// Which of the conditions this value of register `reg` means: bit n is tmc22xx_conditions[n].
uint32_t tmc22xx_conditions_of(uint8_t reg, uint32_t value);

// Highest threshold of temperature that DRV_STATUS says is reached, in degrees C: 0 (none), 120,
// 143, 150 or 157.
unsigned tmc22xx_temperature(uint32_t drv_status);

#endif
