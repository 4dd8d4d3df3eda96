// How the drivers are, as far as is known, and what of it the user is to be told. Context: main
// loop.
#ifndef TMC22XX_MONITOR_H
#define TMC22XX_MONITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "tmc22xx/drivers.h"

// A driver has answered; was found to have been reset; has failed; and what its registers said.
void monitor_note_answer(driver_t *entry);
void monitor_note_reset(driver_t *entry);
void monitor_note_failure(driver_t *entry, uint8_t fault, bool is_monitor);
void monitor_note(driver_t *entry, uint32_t gstat, uint32_t drv_status);

// It is time to look at a driver.
bool monitor_is_due(void);

// The driver that is to be looked at now; DRIVERS_NONE: none. To be asked while no job is under
// way.
unsigned monitor_take_turn(void);

#endif
