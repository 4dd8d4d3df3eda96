// What a job does one after the other: phases, each of which is one access or several of a kind.
// Context: main loop.
#ifndef TMC22XX_PHASES_H
#define TMC22XX_PHASES_H

#include <stdint.h>

//   set up, verified    IDENTIFY  STATUS  [CLEAR]  DELAY  WRITE ...  LOOK
//   set up or change, not verified                        WRITE ...
//   change, verified; arm (for each driver)               WRITE ...  LOOK
//   a register that is not kept                           RAW        LOOK
//   read                                                  READ ...   LOOK
//   monitor                                               READ ...
//
// If an access fails and kept registers have been written, RESTORE writes what they were before;
// what cannot be restored is `dirty` and is written first by the next job that changes something,
// or behind a look of the monitor that finds the driver well.
// If nobody answers to IDENTIFY, KNOCK finds out who else does.
typedef enum {
    PHASES_IDENTIFY,
    PHASES_STATUS,
    PHASES_CLEAR,
    PHASES_DELAY,
    PHASES_WRITE,
    PHASES_RAW,
    PHASES_READ,
    PHASES_LOOK,
    PHASES_RESTORE,
    PHASES_KNOCK
} phases_t;

// Begins a phase, or its next access.
void phases_enter(phases_t phase);

// The access of the phase is done.
void phases_go_on(void);

#endif
