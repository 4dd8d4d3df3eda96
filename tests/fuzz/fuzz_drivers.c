// The drivers, and what goes wrong with them: by the seed of the session.
#include "fuzz_drivers.h"

#include "fuzz_random.h"
#include "fuzz_session.h"
#include "simulate_tmc_wire.h"

#define FAULT_FRAMES_MAX 40
#define FAULT_FROM_MS_MAX 30000
#define FAULT_MS_MAX 5000

static struct {
    simulate_axis_t axis;
    simulate_tmc_t list[3];
    bool may_fail;
} drivers;

// From some time on, for some frames or for good.
static void break_one(simulate_tmc_t *tmc) {
    simulate_chip_fault_t fault =
        (simulate_chip_fault_t)fuzz_random_below((unsigned)SIMULATE_CHIP_FAULTS);
    uint64_t from_ns = (uint64_t)fuzz_random_below(FAULT_FROM_MS_MAX) * 1000000u;
    bool passes = fuzz_random_percent(50);
    uint64_t until_ns = from_ns + (uint64_t)fuzz_random_below(FAULT_MS_MAX) * 1000000u;
    simulate_faults_set(&tmc->faults, fault, from_ns, passes ? until_ns : UINT64_MAX);
    if (simulate_faults_of_wire(fault) && fuzz_random_percent(80)) {
        simulate_faults_limit(&tmc->faults, fault,
                              1 + (int32_t)fuzz_random_below(FAULT_FRAMES_MAX));
    }
}

void fuzz_drivers_attach(void) {
    drivers.axis = (simulate_axis_t){.step_gpio = 2, .dir_gpio = 3};
    bool room = simulate_axis_attach(&drivers.axis);
    drivers.may_fail = fuzz_random_percent(50);
    for (unsigned i = 0; i < COUNT_OF_ARRAY(drivers.list); i++) {
        simulate_tmc_t *tmc = &drivers.list[i];
        bool is_2208 = i == 2;
        simulate_tmc_init(tmc);
        tmc->chip = is_2208 ? 2208 : 2209;
        tmc->address = is_2208 ? 0 : i;
        tmc->tx_gpio = is_2208 ? 22 : 21;
        tmc->rx_gpio = is_2208 ? 19 : 21;
        tmc->axis = i == 0 ? &drivers.axis : NULL;
        for (unsigned faults = drivers.may_fail ? fuzz_random_below(3) : 0; faults > 0; faults--) {
            break_one(tmc);
        }
        room = room && simulate_tmc_attach(tmc) && simulate_tmc_wire_attach(tmc);
    }
    FUZZ_SESSION_CHECK(room, "no room for the drivers");
}

void fuzz_drivers_plant_write(void) {
    drivers.list[0].writes++;
}

uint32_t fuzz_drivers_writes(void) {
    uint32_t writes = 0;
    for (unsigned i = 0; i < COUNT_OF_ARRAY(drivers.list) && !drivers.may_fail; i++) {
        writes += drivers.list[i].writes;
    }
    return writes;
}
