// Handlers of the Trinamic drivers: set-up, wires, axes; and how a statement waits for a driver.
// Inside basic_cmds/ only. Context: main loop.
#ifndef BASIC_CMDS_TMC_H
#define BASIC_CMDS_TMC_H

#include "basic/basic.h"
#include "stepper/stepper.h"
#include "tmc22xx/tmc22xx.h"

// A driver by its address or by its axis, and the first of these among the choices.
#define TMC_AXES "X|Y|Z|A"
#define TMC_DRIVERS "0|1|2|3|" TMC_AXES
#define TMC_FIRST_AXIS 4

// Where each argument stands in the row's spec.
enum {
    TMC_SET_UP_PIN,
    TMC_SET_UP_CHIP,
    TMC_SET_UP_ADDRESS,
    TMC_SET_UP_RUN,
    TMC_SET_UP_HOLD,
    TMC_SET_UP_MICROSTEPS,
    TMC_SET_UP_R_SENSE,
    TMC_SET_UP_STEALTH,
    TMC_SET_UP_ARGS
};
#define TMC_CHIPS "2208|2209"
#define TMC_MICROSTEPS "1|2|4|8|16|32|64|128|256" // the index is the power of two

err_t tmc_set_up(const basic_arg_t *args, size_t count);
err_t tmc_wire(const basic_arg_t *args, size_t count);
err_t tmc_axis(const basic_arg_t *args, size_t count);
err_t tmc_verify(const basic_arg_t *args, size_t count);
err_t tmc_monitor(const basic_arg_t *args, size_t count);
err_t tmc_close(const basic_arg_t *args, size_t count);

// ---- For the handlers of other files ------------------------------------------------------------

// Waits until a job of somebody else, the monitor for instance, is done. To be called right before
// a job is begun. Error: Ctrl-C.
err_t tmc_await_turn(void);

// Waits for its turn in the same way, and finds the driver that two arguments name: its address or
// its axis, and its wire if that is given.
err_t tmc_begin(const basic_arg_t *driver, const basic_arg_t *wire, unsigned *found);

// Waits for the end of the job that was begun with this result, and returns how it ended. Ctrl-C
// gives it up.
err_t tmc_finish(err_t begun);

// Error: it is faster than its axis, which is configured, can go.
err_t tmc_check_feed(unsigned axis, double feed);

// TSTEP at a feed (units/min) of a driver that is tied to a configured axis.
uint32_t tmc_tstep(unsigned driver, double feed);

// The same driver is in StealthChop at this feed: StallGuard needs it.
bool tmc_is_stealthy(unsigned driver, double feed);

// Tells if the driver cannot give the current that was asked for, or only a good deal more.
void tmc_warn_of_current(unsigned driver);

// Tells if its axis needs another scale, since it had so many microsteps before; 0: not known.
void tmc_warn_of_scale(unsigned driver, unsigned before);

// The error for a setting that would change where steps lead while motion is active or queued.
err_t tmc_check_still(const char *what);

// ---- Life cycle ---------------------------------------------------------------------------------

// RUN and NEW: all wires are released, as after power-up. Nothing is written to the drivers.
void tmc_new(void);

// For the background hook: takes jobs on and tells what the monitor has found, once a statement has
// called tmc_await_turn().
void tmc_background(void);

#endif
