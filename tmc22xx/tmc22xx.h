// Trinamic TMC2208 and TMC2209 drivers on wires of one line: which there are, what they are set to,
// and jobs that write and read their registers in the background. The face of tmc22xx/.
//
// A job is what one statement does: accesses to one driver in order. A begin_... or set_... starts
// it and returns at once; tmc22xx_background() takes it on, nothing here waits. One job at a time:
// while another one is under way, the monitor's for instance, all that begins raises ERR_TMC_BUSY,
// and the caller tries again when tmc22xx_busy() is false. What a job changes in the tables below
// counts when it has succeeded; one that fails leaves them as they were.
// Context: main loop.
#ifndef TMC22XX_H
#define TMC22XX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/base.h"
#include "tmc22xx/settings.h" // tmc22xx_settings_t, currents, TSTEP
#include "tmc22xx/status.h"   // conditions, temperature

#define TMC22XX_DRIVERS 8u
#define TMC22XX_ADDRESSES 4u // on one wire
#define TMC22XX_NO_AXIS 0xFFu
#define TMC22XX_READS 8u // registers that one job reads, at most
#define TMC22XX_BAUD 115200u
#define TMC22XX_BAUD_MIN 9600u
#define TMC22XX_BAUD_MAX 500000u

// ---- Wires --------------------------------------------------------------------------------------

// How a wire is wired; claims its pins. `rx_gpio` may be the same pin, which then sends and
// listens. A wire that is there already changes, and the drivers on it stay. A driver that is set
// up on a pin without a wire gets one of one pin and TMC22XX_BAUD.
// Errors: pins, too many wires, busy; the wire is as it was.
err_t tmc22xx_wire(uint8_t tx_gpio, uint8_t rx_gpio, uint32_t baud);

// Gives the wire's pins back and forgets its drivers; no register is written. A job under way there
// ends with an error. PINS_NONE: all wires. Errors: no such wire ("TMC22xx not initialized").
err_t tmc22xx_close(uint8_t tx_gpio);

// ---- Drivers ------------------------------------------------------------------------------------

// Index of the driver, 0 to TMC22XX_DRIVERS - 1, by its address. `tx_gpio`: its wire, or PINS_NONE:
// any. Errors: there is none ("TMC22xx not initialized"), or several wires have one.
err_t tmc22xx_find(unsigned address, uint8_t tx_gpio, unsigned *driver);

// The same by the axis it is tied to (0 to 3); of two the first one.
err_t tmc22xx_find_axis(unsigned axis, unsigned *driver);

// The driver belongs to an axis from now on; TMC22XX_NO_AXIS: to none. Several may belong to one.
void tmc22xx_tie(unsigned driver, unsigned axis);

// What a driver was set up with last, complete with later changes of current and mode; NULL: there
// is none with this index. Valid until the next call.
const tmc22xx_settings_t *tmc22xx_driver(unsigned driver);

typedef struct {
    uint8_t axis; // TMC22XX_NO_AXIS: none
    bool listens; // was set up with verification, so it can answer
    bool armed;   // by tmc22xx_begin_arm(); or perhaps, since it could not be told to be not
    bool lost;    // it has lost its settings, as far as is known
    uint8_t rx_gpio;
    uint32_t baud;
    uint8_t irun, ihold;    // current scales, 0 to 31
    bool vsense;            // the finer of the two ranges of current
    double run_ma, hold_ma; // what they really give
    // What the user has written; TSTEP units, SG_RESULT / 2.
    uint32_t tpwmthrs, tcoolthrs;
    uint8_t sgthrs;
    uint32_t kept_tcoolthrs; // for arming, from tmc22xx_keep_threshold() by the user; 0: none
    uint8_t ifcnt;           // writes the driver has counted, as last seen
    uint16_t repeats;        // frames sent again since it was set up first
    uint16_t failures;       // accesses that did not succeed in spite of that
} tmc22xx_info_t;

// False: there is no driver with this index.
bool tmc22xx_info(unsigned driver, tmc22xx_info_t *info);

// The value written last to a register, if it is one of those that are kept (GCONF, IHOLD_IRUN,
// TPOWERDOWN, TPWMTHRS, TCOOLTHRS, SGTHRS, COOLCONF, CHOPCONF, PWMCONF).
bool tmc22xx_written(unsigned driver, uint8_t reg, uint32_t *value);

// The TCOOLTHRS with which tmc22xx_begin_arm() is to arm the driver. `by_user`: by a statement; 0
// takes it back. Otherwise it is homing's own choice, which counts as long as the user has neither
// kept nor written one.
void tmc22xx_keep_threshold(unsigned driver, uint32_t tcoolthrs, bool by_user);

// ---- Jobs ---------------------------------------------------------------------------------------

// Whether writes are verified: on at start. Off: they are sent and nothing is asked, for boards
// without a way back.
void tmc22xx_verify(bool on);
bool tmc22xx_verifies(void);

// Sets a driver up: its five registers, and if it has been set up before and was without power, all
// that was written later. A new driver enters the table when the job has succeeded, and it is tied
// to no axis. Errors at once: settings that cannot be, pins, too many drivers.
err_t tmc22xx_set_up(const tmc22xx_settings_t *settings);

// Changes. A negative `hold_percent` leaves it as it is.
err_t tmc22xx_set_current(unsigned driver, double run_ma, double hold_percent);

// The fields of COOLCONF; `semin` 0 switches CoolStep off.
typedef struct {
    uint8_t semin, semax, seup, sedn, seimin;
} tmc22xx_coolstep_t;
err_t tmc22xx_set_coolstep(unsigned driver, const tmc22xx_coolstep_t *coolstep);

// StealthChop, above the speed of `tpwmthrs` SpreadCycle (0: at no speed); or SpreadCycle always.
err_t tmc22xx_set_stealth(unsigned driver, bool on, uint32_t tpwmthrs);

// A single register, a threshold for instance. One that is kept goes on from here when a setting
// changes. Errors: the chip has no such register, it cannot be written, it must not (OTP_PROG), or
// the value does not fit.
err_t tmc22xx_begin_write(unsigned driver, uint8_t reg, uint32_t value);

// Reads up to TMC22XX_READS registers for tmc22xx_value().
err_t tmc22xx_begin_read(unsigned driver, const uint8_t *registers, size_t count);

// For homing: TCOOLTHRS of several drivers (bit n: driver n) is armed with the threshold kept for
// it (by the user, else what the user wrote, else homing's), or is put back to what the user has
// written. If a driver fails at arming, those behind it are left; disarming goes on with the
// others. Has a result of its own, so that no statement can take it.
err_t tmc22xx_begin_arm(uint32_t drivers, bool on);
bool tmc22xx_arm_busy(void);
err_t tmc22xx_arm_result(void); // raised anew

// A job is under way, whoever's.
bool tmc22xx_busy(void);

// How the last job of a statement ended, raised anew.
err_t tmc22xx_result(void);

// What it has read; `index` as in `registers`.
uint32_t tmc22xx_value(unsigned index);

// Gives the job of the statement up, if it is still under way: Ctrl-C. What is on the wire ends by
// itself, and registers that were written are put back; until then tmc22xx_busy() is true.
void tmc22xx_give_up(void);

// Takes jobs on, quickly. To be called whenever the main loop comes round, and no later than
// tmc22xx_wake_us() if a job is to be as fast as the wire; UINT64_MAX: nothing is under way. The
// monitor wakes nobody: it looks when the main loop is awake anyway.
void tmc22xx_background(void);
uint64_t tmc22xx_wake_us(void);

// ---- Monitor ------------------------------------------------------------------------------------

// While no job is under way, each driver that can answer is asked once a second how it is; on at
// start.
void tmc22xx_monitor(bool on);
bool tmc22xx_monitors(void);

// The next thing worth telling the user, once until it changes: a driver that is too hot, has a
// short circuit, has lost its settings, does not answer or answers again. False: none.
bool tmc22xx_next_event(char *text, size_t size);

#endif
