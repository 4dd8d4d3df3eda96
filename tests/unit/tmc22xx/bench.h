// Statements for the drivers on the wires of line.h: what one begins, and how it ends.
#ifndef TESTS_TMC22XX_BENCH_H
#define TESTS_TMC22XX_BENCH_H

#include "line.h"
#include "tmc22xx/tmc22xx.h"

#define BENCH_WIRE 16
#define BENCH_OTHER_WIRE 5

// A TMC2209 at address 0 of BENCH_WIRE; and the same elsewhere.
extern const tmc22xx_settings_t bench_usual;
tmc22xx_settings_t bench_settings(uint8_t tx_gpio, uint8_t address);

// Sets up what bench_settings() gives, which succeeds. Returns the driver.
unsigned bench_set_up(uint8_t tx_gpio, uint8_t address);

// Lets a job that was begun with this result end, and says how it has ended.
err_t bench_end(err_t begun);

// The same, and how it has to.
void bench_succeeds(err_t begun);
void bench_fails(err_t begun, const char *message);

// It was not even begun.
void bench_refused(err_t begun, const char *message);

// "W00 000001C0 R02 ": what was sent since line_expect(), in order. Valid until the next call.
const char *bench_sent(void);

#endif
