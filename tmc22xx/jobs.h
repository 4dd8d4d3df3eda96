// The job under way: a chain of accesses to one driver, and what follows when one of them fails.
// What tmc22xx.h says about the job under way and its result is in jobs.c as well. Context: main
// loop.
#ifndef TMC22XX_JOBS_H
#define TMC22XX_JOBS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tmc22xx/drivers.h"

// ---- Beginning one; none may be under way -------------------------------------------------------

// Sets up the driver that `entry` describes completely. `driver`: its place in the table, or
// DRIVERS_NONE. `opened`: the wire was opened for it, and closes again if it fails.
void jobs_set_up(unsigned driver, const driver_t *entry, bool opened);

// Makes the driver in the table what `entry` says; `kept`: the registers that differ, as bits.
void jobs_change(unsigned driver, const driver_t *entry, uint32_t kept);

// Writes a register that is not kept.
void jobs_write(unsigned driver, uint8_t reg, uint32_t value);

void jobs_read(unsigned driver, const uint8_t *registers, size_t count);
void jobs_arm(uint32_t drivers, bool on);

// Reads GSTAT and DRV_STATUS for monitor_note().
void jobs_look_after(unsigned driver);

// ---- Under way ----------------------------------------------------------------------------------

// Takes it on as far as it goes without waiting; no effect if there is none.
void jobs_step(void);

// Of a job for several drivers: turns to the next one; false: there is none.
bool jobs_turn_to_next_armed(void);

// The wire closes. A job on it ends at once.
void jobs_cut(unsigned wire);

#endif
