// One register of one driver, written or read so that the outcome is certain: what failed is tried
// again, what was written is counted by the driver (IFCNT). Context: main loop.
//
// An answer says which register it is about, but not which request it is for. So after one that
// did not come as it should the wire is not trusted: the next request is for another register (in
// turn one of several), and only its answer shows that none is outstanding. An old IFCNT is never
// taken for a new one, not even from a driver that answers each request too late. (Nor does it say
// who it is from: an answer of another driver on the wire would have to be later than the wire is
// quiet, see exchange.h.)
#ifndef TMC22XX_ACCESS_H
#define TMC22XX_ACCESS_H

#include <stdbool.h>
#include <stdint.h>

#define ACCESS_REPEATS 2u // a request or a write is sent once and so often again

typedef enum { ACCESS_BUSY, ACCESS_DONE, ACCESS_FAILED } access_state_t;

typedef enum {
    ACCESS_OK,
    ACCESS_SILENT,    // no answer
    ACCESS_GARBLED,   // answers that are none
    ACCESS_HELD_LOW,  // the line is low: nothing could be sent
    ACCESS_NOT_TAKEN, // it answers, but does not count what is written
    ACCESS_LOST,      // it was reset and has lost all settings
    ACCESS_CANCELLED
} access_fault_t;

// Turns to a driver: how many writes it has counted is not known. `knows_resets`: GSTAT.reset was
// cleared, so that it tells of a reset.
void access_turn_to(unsigned wire, uint8_t address, bool knows_resets);

// Each begins one access, when none is under way.
void access_read(uint8_t reg);
void access_write(uint8_t reg, uint32_t value, bool verify);

// Asks once only, for any register, in turn: is somebody there?
void access_knock(void);

// Takes the access on until it waits or is over.
access_state_t access_poll(void);

// What was read, or why it failed.
uint32_t access_value(void);
access_fault_t access_fault(void);

// The write failed, but the driver may have taken it.
bool access_is_in_doubt(void);

// How many requests and writes were sent again since it was asked last.
unsigned access_take_repeats(void);

// IFCNT as it was read last of this driver; false: it was not.
bool access_count(uint8_t *count);

// Ends the access as soon as what is on the wire is over.
void access_cancel(void);

// The wire closes; `under_way`: with an access on it, which ends at once.
void access_cut(unsigned wire, bool under_way);

#endif
