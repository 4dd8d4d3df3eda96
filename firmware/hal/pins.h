// Who owns which pin, and what a pin is called. The 40-pin header is the same on Pico and Pico 2.
// Context: main loop.
#ifndef HAL_PINS_H
#define HAL_PINS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

#define PINS_COUNT 30   // GP0..GP29
#define PINS_NONE 0xFFu // no pin assigned

// True for a GPIO a user may have: on the header, or GP25 (the board's LED; on a Pico W the chip
// select of the radio, which stays without power as GP23, its switch, cannot be had: no harm, but
// no light either).
bool pins_is_user(unsigned gpio);

// Number on the 40-pin header, 0 if it is not there (GP23..25, 29).
unsigned pins_board_number(unsigned gpio);

// GPIO of a header pin number, PINS_NONE if that pin is power, ground or control.
unsigned pins_from_board_number(unsigned board_number);

// Why a GPIO, or a header pin's number, is none a user may have: "ground". A short text.
const char *pins_why_not(unsigned gpio);
const char *pins_why_not_board_number(unsigned board_number);

// "GP16 (pin 21)"; "GP25" where there is no header pin; "none". Valid until the fourth next call.
const char *pins_name(unsigned gpio);

// Reserves the pin for `owner` (a constant text such as "STEPPER X step").
// Errors: not a user pin, or in use - the message names who has it. Fails without changing
// anything.
err_t pins_claim(unsigned gpio, const char *owner);

// Who has it; NULL: nobody.
const char *pins_owner(unsigned gpio);

// Forgets the reservation; the caller has put the pin back to what it was. PINS_NONE is ignored.
void pins_disclaim(unsigned gpio);

// 1 << gpio, or 0 for PINS_NONE.
static inline uint32_t pins_mask(unsigned gpio) {
    return gpio < 32 ? (uint32_t)1 << gpio : 0;
}

#endif
