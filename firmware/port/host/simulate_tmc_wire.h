// A simulated driver at its wire: datagrams, when it listens and how it answers, and what goes
// wrong there. Context: any (called when virtual time reaches the end of a frame).
//
//  * A datagram counts if sync, address and checksum are right and each byte has its stop bit:
//    05 address register data x 4 checksum writes, 05 address register checksum asks.
//  * Behind an error the receiver wants 12 bit times of silence. More than 63 bit times from one
//    start bit to the next begin a new datagram.
//  * The answer, 05 FF register data x 4 checksum, starts SENDDELAY behind the request. The other
//    drivers of the wire hear it, too, and take it for a broken request: unless their SENDDELAY is
//    longer than a byte that costs them 12 bit times.
//  * A driver that has an answer to give does not hear another request.
#ifndef SIMULATE_TMC_WIRE_H
#define SIMULATE_TMC_WIRE_H

#include "simulate_tmc.h"
#include "simulate_wire.h"

// Starts at zero, but for the driver.
typedef struct {
    simulate_tmc_t *tmc;
    unsigned listener; // at the wire
    bool holds;        // pulls it low
    uint8_t bytes[8];  // of the datagram that is coming in
    unsigned count;
    uint64_t start_ns; // of its last byte
    uint64_t end_ns;
    uint64_t answers_ns; // its own answer is over then
    bool error;          // waits for silence
    uint32_t random;
} simulate_tmc_wire_t;

// Connects an attached driver with its wire. False if there is no room.
bool simulate_tmc_wire_attach(simulate_tmc_t *tmc);

// Hears what ends at `end_ns`, now. True: `answer` is what it says to it.
bool simulate_tmc_wire_hear(simulate_tmc_wire_t *wire, const simulate_wire_words_t *words,
                            uint64_t end_ns, simulate_wire_words_t *answer);

// The checksum of a datagram, in front of which it stands.
uint8_t simulate_tmc_wire_checksum(const uint8_t *bytes, unsigned size);

// Holds wires low whose drivers have lost their supply by now.
void simulate_tmc_wire_run(uint64_t now_ns);

// Told about each datagram that a driver has taken. NULL: nobody.
typedef struct {
    const simulate_tmc_t *tmc;
    uint64_t time_ns;
    unsigned address;
    bool is_write;
    uint32_t value; // written, or answered
} simulate_tmc_access_t;

void simulate_tmc_wire_watch(void (*watcher)(const simulate_tmc_access_t *access));

#endif
