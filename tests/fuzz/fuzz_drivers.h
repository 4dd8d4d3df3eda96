// Simulated motor drivers on wires, for sessions at the prompt; in half of the sessions some of
// them fail in one way or another.
#ifndef FUZZ_DRIVERS_H
#define FUZZ_DRIVERS_H

#include <stdint.h>

// Puts them at the pins: two TMC2209 on GP21, one of them moves an axis on GP2 and GP3; a TMC2208
// that sends on GP22 and hears on GP19. Once for each process.
void fuzz_drivers_attach(void);

// Registers that all of them together have taken, as long as none of them may fail: what a refused
// line must not change. Else 0.
uint32_t fuzz_drivers_writes(void);

// One more, for FUZZ_PLANT_DRIVER_WRITE.
void fuzz_drivers_plant_write(void);

#endif
