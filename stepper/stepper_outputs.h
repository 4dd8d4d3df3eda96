// What rides in the queue beside motion: spindle, coolant, pauses, and the line number of each
// entry. A face of stepper/ beside stepper.h, whose rules apply. Context: main loop.
#ifndef STEPPER_STEPPER_OUTPUTS_H
#define STEPPER_STEPPER_OUTPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/base.h"

// ---- Spindle ------------------------------------------------------------------------------------

#define STEPPER_SPINDLE_RPM_MAX 1e6
#define STEPPER_SPINDLE_PWM_HZ_DEFAULT 1000.0
#define STEPPER_SPINDLE_SPINUP_MS_MAX 600000u

typedef struct {
    uint8_t gpio;       // PINS_NONE: there is no spindle
    uint8_t dir_gpio;   // low: clockwise, high: counter-clockwise; PINS_NONE: clockwise only
    bool invert;        // of gpio: low is on, with PWM the pulses are low
    double max_rpm;     // at 100 % duty, 0..STEPPER_SPINDLE_RPM_MAX; 0: on and off only, no PWM
    double min_rpm;     // lower speeds above 0 become this one, 0..max_rpm
    double pwm_hz;      // > 0
    uint32_t spinup_ms; // wait behind each start and reversal, 0..STEPPER_SPINDLE_SPINUP_MS_MAX
} stepper_spindle_t;

// Sets the spindle up, switched off, or takes it away. With PWM the pin's whole slice belongs to
// it. A refused call changes nothing. Errors: not initialised, moving or queued, pins or slice
// taken, one pin twice, a frequency that the board cannot make, min above max, no PWM for a laser.
err_t stepper_spindle(const stepper_spindle_t *config);

typedef enum { STEPPER_SPINDLE_OFF, STEPPER_SPINDLE_CW, STEPPER_SPINDLE_CCW } stepper_turn_t;

// Switches the spindle at this place of the queue, at standstill: one entry, which includes the
// wait for spin-up if the spindle starts or turns round there. With PWM the duty is rpm / max_rpm;
// without, rpm counts for nothing. A speed of 0 stands still. A speed above max_rpm becomes
// max_rpm, see stepper_spindle_limited(). To change the speed in motion see
// stepper_move_t.sets_spindle. Further errors: no spindle pin; CCW without a direction pin.
err_t stepper_spindle_switch(stepper_turn_t turn, double rpm);

// Whether stepper_spindle_switch() would be refused because of the spindle's pins; raises it.
err_t stepper_spindle_check(stepper_turn_t turn);

// The spindle output is a laser, or no longer; it is off then and in both cases until the next
// stepper_spindle_switch(). That one is no entry of the queue then, it counts for the moves queued
// from now on: CW is constant power; CCW power in proportion to the speed along the path, of which
// the programmed feed has all; no direction pin and no spin-up are needed. The beam is off in rapid
// moves, jogs, homing and probing, and when nothing moves. It also stays off, as if OFF had been
// asked for, after whatever drops the queue, and in a controlled stop from its beginning on.
// stepper_close(), and a spindle that is taken away, end this. Errors: not initialised, moving or
// queued, the spindle has no PWM.
err_t stepper_laser(bool on);
bool stepper_is_laser(void);

// As stepper_spindle_switch() to OFF, but never refused. Nothing if there is no laser.
void stepper_laser_off(void);

// As stepper_dwell(), but a laser of constant power stays on in it as it was switched.
err_t stepper_laser_dwell(double milliseconds);

// True once after a speed above max_rpm was asked for since the spindle was set up.
bool stepper_spindle_limited(void);

// ---- Coolant ------------------------------------------------------------------------------------

typedef struct {
    uint8_t flood_gpio, mist_gpio; // PINS_NONE: there is none
    bool invert;                   // low is on
} stepper_coolant_t;

// Sets the coolant up, switched off, or takes it away. A refused call changes nothing. Errors: not
// initialised, moving or queued, pins taken, one pin twice.
err_t stepper_coolant(const stepper_coolant_t *config);

// Switches both at this place of the queue, at standstill: one entry. Further errors: one that
// should be on has no pin.
err_t stepper_coolant_switch(bool flood, bool mist);

// Whether stepper_coolant_switch() would be refused because of the pins; raises it.
err_t stepper_coolant_check(bool flood, bool mist);

// ---- Pause --------------------------------------------------------------------------------------

// When this entry is reached the machine stands, drivers and spindle as they are, until
// stepper_hold(false) goes on behind it; a stop drops it like everything else.
err_t stepper_pause(void);

// The machine stands at such an entry.
bool stepper_paused(void);

// How many such entries it has come to since INIT.
uint32_t stepper_pauses(void);

// ---- Line numbers -------------------------------------------------------------------------------

// Entries queued from now on came from this line; 0: from none.
void stepper_set_line(uint32_t line);

// That of the entry being executed; 0: none is, or it came from none. 2 ms ahead of the motors.
uint32_t stepper_line(void);

// ---- Reports ------------------------------------------------------------------------------------

typedef struct {
    stepper_spindle_t spindle;
    bool laser;
    stepper_turn_t turn; // as of the last switch that was carried out; of a laser: queued
    double rpm;          // now; without PWM 0
    bool spindle_on;     // the output is on, with PWM at a speed above 0
    stepper_coolant_t coolant;
    bool flood, mist; // now
} stepper_outputs_t;

void stepper_outputs(stepper_outputs_t *outputs);

#endif
