// Wires with driver chips in memory, for the unit tests of jobs: hal_wire.h and the clock, chips as
// far as jobs can see them, and faults at chosen frames.
#ifndef TESTS_TMC22XX_LINE_H
#define TESTS_TMC22XX_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/hal_wire.h"

#define LINE_CHIPS 8u
#define LINE_FRAMES 400u

typedef struct {
    uint8_t tx_gpio;
    uint8_t address;
    bool is_2208;
    bool gone; // without power, or not connected
    bool deaf; // answers, but takes no writes
    uint32_t registers[128];
    uint8_t ifcnt;
    uint8_t send_delay; // bit times before an answer
} line_chip_t;

// What happens to the frame with a certain number, counted from 0 since line_expect().
typedef enum {
    LINE_GOOD,
    LINE_LOST,         // the chip does not get it
    LINE_NO_REPLY,     // it gets it, and its answer is lost (a write is lost itself)
    LINE_BAD_CRC,      // one bit of the answer, or of the write, is another one
    LINE_OTHER_REG,    // a whole answer about another register
    LINE_OTHER_MASTER, // a whole answer for somebody else
    LINE_NOISE,        // a byte without stop bit
    LINE_HALF,         // the second half of the answer is missing
    LINE_LATE,         // the answer comes line.late_us later
    LINE_RESET,        // the chip was reset before it
    LINE_RESET_BEHIND, // and behind it, when it has answered
    LINE_HELD_LOW,     // nothing can be sent
    LINE_FAULTS
} line_fault_t;

typedef struct {
    uint64_t time_us; // of its first bit
    uint8_t tx_gpio;
    uint8_t size;
    uint8_t bytes[HAL_WIRE_SEND_MAX];
} line_frame_t;

// To be set by tests.
typedef struct {
    uint64_t time_us;
    line_chip_t chips[LINE_CHIPS];
    size_t chip_count;
    uint32_t late_us;
    bool behind; // chips answer each request with the answer to the one before
    // Called at each frame, before it has an effect; NULL: all are good.
    line_fault_t (*fault)(size_t frame);
    // What was sent; more than LINE_FRAMES are counted only.
    line_frame_t frames[LINE_FRAMES];
    size_t frame_count;
} line_t;

extern line_t line;

// No chips, time 0, all wires closed.
void line_reset(void);

// A chip as after power-up. Valid until line_reset().
line_chip_t *line_add(uint8_t tx_gpio, uint8_t address);
void line_power_up(line_chip_t *chip);

// Counts frames from here.
void line_expect(line_fault_t (*fault)(size_t frame));

bool line_is_open(uint8_t tx_gpio);

// Lets the job under way end, however long it takes; returns how long in microseconds.
uint64_t line_run(void);

// The same until this time at the latest.
void line_run_until(uint64_t time_us);

const char *line_fault_name(line_fault_t fault);

#endif
