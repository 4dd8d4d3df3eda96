// Faults of a simulated driver chip, by name: what goes wrong, from when on, how often. Context:
// any.
#ifndef SIMULATE_FAULTS_H
#define SIMULATE_FAULTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    // On the wire, for a number of frames to this driver:
    SIMULATE_CHIP_SILENT,    // "silent": takes what is sent and does not answer
    SIMULATE_CHIP_DEAF,      // "deaf": takes nothing, answers nothing
    SIMULATE_CHIP_UNPLUGGED, // "unplugged": the same; the wire is off
    SIMULATE_CHIP_BAD_CRC,   // "bad-crc": of the reply
    SIMULATE_CHIP_LATE,      // "late": the reply comes 2 to 10 ms after it should
    SIMULATE_CHIP_GARBLED, // "garbled": a bit of a frame turns over, in either direction; of every
                           // second frame, without a number
    // Of the chip, with a value:
    SIMULATE_CHIP_UNPOWERED,        // "unpowered": without supply, it pulls the wire low
    SIMULATE_CHIP_BROWN_OUT,        // "brown-out": once, all registers as after power-up
    SIMULATE_CHIP_OVER_TEMPERATURE, // "over-temperature": degrees Celsius, else 120
    SIMULATE_CHIP_SHORT,            // "short": of a coil to ground; the driver switches off
    SIMULATE_CHIP_OPEN_LOAD,        // "open-load": a coil is not connected
    SIMULATE_CHIP_STALL,            // "stall": the axis is blocked at this place of it
    SIMULATE_CHIP_FAULTS
} simulate_chip_fault_t;

#define SIMULATE_CHIP_FOR_EVER UINT32_MAX

typedef struct {
    struct {
        bool set;
        bool begun; // as simulate_faults_change() saw it last
        uint64_t from_ns, until_ns;
        uint32_t frames; // left; SIMULATE_CHIP_FOR_EVER
        int32_t value;
    } list[SIMULATE_CHIP_FAULTS];
} simulate_faults_t;

const char *simulate_faults_name(simulate_chip_fault_t fault);

// SIMULATE_CHIP_FAULTS: no fault has this name.
simulate_chip_fault_t simulate_faults_by_name(const char *name, size_t length);

// It is one of the wire, with a number of frames; else it has a value.
bool simulate_faults_of_wire(simulate_chip_fault_t fault);

// Begins it at a time and ends it at another, UINT64_MAX: never. Replaces what was set for this
// fault.
void simulate_faults_set(simulate_faults_t *faults, simulate_chip_fault_t fault, uint64_t from_ns,
                         uint64_t until_ns);

// Number of frames, or value.
void simulate_faults_limit(simulate_faults_t *faults, simulate_chip_fault_t fault, int32_t number);

// It is there at this time.
bool simulate_faults_active(const simulate_faults_t *faults, simulate_chip_fault_t fault,
                            uint64_t now_ns);

// It is there, and this frame is one of those it strikes.
bool simulate_faults_strikes(simulate_faults_t *faults, simulate_chip_fault_t fault,
                             uint64_t now_ns);

typedef enum {
    SIMULATE_FAULTS_STAYS,
    SIMULATE_FAULTS_BEGINS,
    SIMULATE_FAULTS_ENDS
} simulate_faults_change_t;

// What has become of it since the last call.
simulate_faults_change_t simulate_faults_change(simulate_faults_t *faults,
                                                simulate_chip_fault_t fault, uint64_t now_ns);

// When the next one begins or ends that is none of the wire, UINT64_MAX: never.
uint64_t simulate_faults_next_ns(const simulate_faults_t *faults);

#endif
