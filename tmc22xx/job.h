// The job under way, as phases.c, endings.c and jobs.c share it. Context: main loop.
#ifndef TMC22XX_JOB_H
#define TMC22XX_JOB_H

#include <stdbool.h>
#include <stdint.h>

#include "tmc22xx/drivers.h"
#include "tmc22xx/outcome.h"

typedef enum { JOB_NONE, JOB_SET_UP, JOB_CHANGE, JOB_READ, JOB_ARM, JOB_MONITOR } job_kind_t;

typedef struct {
    uint8_t kind;   // job_kind_t
    uint8_t phase;  // phases_t
    uint8_t driver; // in the table; DRIVERS_NONE: a new one
    bool verify;
    bool on;     // JOB_ARM
    bool opened; // the wire, for this job
    bool cancelled;
    bool has_raw;     // a register beside the kept ones is to be written behind them
    uint8_t raw_reg;  // its address
    uint8_t armed;    // JOB_ARM: drivers still to come, as bits
    uint8_t next;     // register to be read, or address to be asked
    uint8_t writing;  // kept register on the wire
    uint16_t pending; // kept registers to be written, as bits
    uint16_t touched; // those that were sent
    uint32_t raw_value;
    uint32_t look[2]; // JOB_MONITOR: GSTAT, DRV_STATUS
    driver_t entry;   // what the driver will be
    outcome_t outcome;
} job_t;

extern job_t job;

// What jobs of statements read.
typedef struct {
    uint8_t registers[TMC22XX_READS];
    uint8_t count;
    uint32_t values[TMC22XX_READS];
} job_reading_t;

extern job_reading_t job_reading;

// The driver in the table; NULL: it is new.
static inline driver_t *job_driver(void) {
    return drivers_get(job.driver);
}

// With a verified driver a flag that was cleared when it was set up tells whether it was reset.
static inline bool job_knows_resets(void) {
    return job.verify && (job.kind == JOB_SET_UP || job_driver()->listens);
}

#endif
