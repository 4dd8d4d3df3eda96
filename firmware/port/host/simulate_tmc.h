// A simulated TMC2209 or TMC2208 with its motor: registers, step input, DIAG, faults by name; its
// receiver and its answers are in simulate_tmc_wire.h. Written from the datasheets (TMC2209 rev.
// 1.09, TMC2208 rev. 1.13) and independent of tmc22xx/, whose tests it judges. Context: any.
//
// What the chip does
//  * Each write that counts adds one to IFCNT, whatever the register. One to a register that is
//    not there or only readable changes nothing; what is not there or only writable reads 0.
//  * TSTEP is the mean over the last 16 pulses, for 1/256 steps; it grows with the time since the
//    last pulse and is 2^20 - 1 at a standstill, 2^20 clocks behind the last one.
//  * CS_ACTUAL is IRUN (or what CoolStep makes of it), at a standstill, TPOWERDOWN behind the last
//    pulse, it goes down to IHOLD, one step each IHOLDDELAY.
//  * DIAG is high after a driver error, and while StealthChop is on, SG_RESULT <= 2 * SGTHRS and
//    TCOOLTHRS >= TSTEP > TPWMTHRS.
// SG_RESULT is renewed at each full step, as
//     510 * v / (v + 60) * (1 - torque) * ripple        v: full steps/s
// with the torque that the motor gives, as part of its full torque, and a ripple of up to 4 % that
// depends on the full step; it is even, as the chip's, and 0 while the motor slips (see
// simulate_motor.h).
//
// What it leaves out: VACTUAL moves nothing, the field does not move between two pulses, only the
// rising edge of a step counts, OTP cannot be written, the supply has no voltage.
#ifndef SIMULATE_TMC_H
#define SIMULATE_TMC_H

#include "simulate.h"
#include "simulate_faults.h"
#include "simulate_motor.h"

#define SIMULATE_TMC_MAX 8u
#define SIMULATE_TMC_REGISTERS 128u
#define SIMULATE_TMC_INTERVALS 16u

// Fill in the first group after simulate_tmc_init(), then simulate_tmc_attach().
typedef struct {
    uint16_t chip;         // 2208, 2209
    unsigned address;      // how MS1 and MS2 are wired: they are its bits 0 and 1
    unsigned tx_gpio;      // the wire it is on, as the firmware sends and
    unsigned rx_gpio;      // as it hears
    unsigned diag_gpio;    // PINS_NONE: not connected
    unsigned enable_gpio;  // PINS_NONE: always on; else a high level switches the motor off
    simulate_axis_t *axis; // NULL: no motor. Its place and its stops count in
    unsigned microsteps;   // such microsteps
    uint32_t sense_mohm;   // without the chip's own 20
    uint32_t clock_khz;
    int32_t skew_1000; // its bits are so much faster than those it has heard
    uint32_t load_ma;  // of the motor, see simulate_motor_t

    simulate_faults_t faults;
    simulate_motor_t motor;
    int64_t mscnt_0;                            // place of the field where MSCNT is 0
    uint32_t registers[SIMULATE_TMC_REGISTERS]; // as written, or as at reset
    uint64_t reset_ns;
    bool too_hot; // switched off until it is cool again
    bool diag;
    uint64_t calm_ns;                   // DIAG is to be looked at then
    uint32_t writes, reads, bad_frames; // taken from the wire, and not

    uint64_t pulse_ns[SIMULATE_TMC_INTERVALS + 1]; // the last pulses, a ring
    unsigned pulses; // in it, since the last standstill or change of microsteps
    unsigned pulse_next;
    uint64_t full_steps;
    uint32_t sg_result;
    uint32_t coolstep_down; // how far CoolStep has lowered the current
    uint32_t coolstep_count;
} simulate_tmc_t;

// A TMC2209 at address 0 with nothing connected, a sense resistor of 0.11 ohm and 12 MHz.
void simulate_tmc_init(simulate_tmc_t *tmc);

// Powers it up, and moves the axis from now on, which has to be attached. False if there is no
// room.
bool simulate_tmc_attach(simulate_tmc_t *tmc);

// The drivers that are attached, in order; NULL behind the last.
simulate_tmc_t *simulate_tmc_at(unsigned index);

// ---- Registers ----------------------------------------------------------------------------------

// The name of a register, NULL if there is none at this address.
const char *simulate_tmc_name(const simulate_tmc_t *tmc, unsigned address);

// As the wire reads and writes it.
uint32_t simulate_tmc_read(simulate_tmc_t *tmc, unsigned address, uint64_t now_ns);
void simulate_tmc_write(simulate_tmc_t *tmc, unsigned address, uint32_t value, uint64_t now_ns);

// What the chip holds there, also where the wire cannot read it.
uint32_t simulate_tmc_register(simulate_tmc_t *tmc, unsigned address, uint64_t now_ns);

// Everything as after power-up.
void simulate_tmc_reset(simulate_tmc_t *tmc, uint64_t now_ns);

// ---- The motor ----------------------------------------------------------------------------------

// Microsteps of a step pulse in a full step: by MRES, or by the pins.
uint32_t simulate_tmc_microsteps(const simulate_tmc_t *tmc);

// Current (rms) through the motor now.
uint32_t simulate_tmc_current_ma(const simulate_tmc_t *tmc, uint64_t now_ns);

// ---- Time ---------------------------------------------------------------------------------------

// Faults that are due, and what DIAG follows from. To be called when something has changed.
void simulate_tmc_update(simulate_tmc_t *tmc, uint64_t now_ns);

// When a driver does something by itself that a pin may show, UINT64_MAX: never; and doing it.
uint64_t simulate_tmc_next_ns(void);
void simulate_tmc_run(uint64_t now_ns);

#endif
