// How a job ended, small enough to be kept until somebody asks, and as an error. Context: main
// loop.
#ifndef TMC22XX_OUTCOME_H
#define TMC22XX_OUTCOME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "tmc22xx/access.h"
#include "tmc22xx/drivers.h"

// Faults of a job beside those of an access.
enum {
    OUTCOME_WRONG_CHIP = ACCESS_CANCELLED + 1, // `found` is the version it has
    OUTCOME_CLOSED
};

typedef struct {
    uint8_t fault; // access_fault_t or one of these; ACCESS_OK: it succeeded
    uint8_t tx_gpio, rx_gpio, address, axis;
    uint8_t chip;      // that was expected, as in driver_t
    uint8_t found;     // VERSION; or, if nobody answers, addresses (bits) where a new driver does
    bool others;       // known drivers on this wire answer
    bool partly;       // the driver's settings are not those before, nor all new ones
    bool is_being_set; // it is no driver yet, or one that is set up anew
} outcome_t;

// Raises it; ERR_OK if there is nothing to raise.
err_t outcome_raise(const outcome_t *outcome);

// "TMC2209 at address 0 on GP16 (pin 21), axis X".
size_t outcome_name(char *text, size_t size, const driver_t *entry);

#endif
