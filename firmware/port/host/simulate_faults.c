// Names of the faults, and which are there. Context: any.
#include "simulate_faults.h"

#include <string.h>

#define HOT_C 120 // where a chip warns

static const char *const fault_names[SIMULATE_CHIP_FAULTS] = {
    [SIMULATE_CHIP_SILENT] = "silent",
    [SIMULATE_CHIP_DEAF] = "deaf",
    [SIMULATE_CHIP_UNPLUGGED] = "unplugged",
    [SIMULATE_CHIP_BAD_CRC] = "bad-crc",
    [SIMULATE_CHIP_LATE] = "late",
    [SIMULATE_CHIP_GARBLED] = "garbled",
    [SIMULATE_CHIP_UNPOWERED] = "unpowered",
    [SIMULATE_CHIP_BROWN_OUT] = "brown-out",
    [SIMULATE_CHIP_OVER_TEMPERATURE] = "over-temperature",
    [SIMULATE_CHIP_SHORT] = "short",
    [SIMULATE_CHIP_OPEN_LOAD] = "open-load",
    [SIMULATE_CHIP_STALL] = "stall",
};

const char *simulate_faults_name(simulate_chip_fault_t fault) {
    return fault_names[fault];
}

simulate_chip_fault_t simulate_faults_by_name(const char *name, size_t length) {
    unsigned i = 0;
    while (i < SIMULATE_CHIP_FAULTS &&
           (strlen(fault_names[i]) != length || memcmp(fault_names[i], name, length) != 0)) {
        i++;
    }
    return (simulate_chip_fault_t)i;
}

bool simulate_faults_of_wire(simulate_chip_fault_t fault) {
    return fault <= SIMULATE_CHIP_GARBLED;
}

void simulate_faults_set(simulate_faults_t *faults, simulate_chip_fault_t fault, uint64_t from_ns,
                         uint64_t until_ns) {
    memset(&faults->list[fault], 0, sizeof faults->list[fault]);
    faults->list[fault].set = true;
    faults->list[fault].from_ns = from_ns;
    faults->list[fault].until_ns = until_ns;
    faults->list[fault].frames = SIMULATE_CHIP_FOR_EVER;
    faults->list[fault].value = HOT_C;
}

void simulate_faults_limit(simulate_faults_t *faults, simulate_chip_fault_t fault, int32_t number) {
    if (simulate_faults_of_wire(fault)) {
        faults->list[fault].frames = (uint32_t)number;
    } else {
        faults->list[fault].value = number;
    }
}

bool simulate_faults_active(const simulate_faults_t *faults, simulate_chip_fault_t fault,
                            uint64_t now_ns) {
    return faults->list[fault].set && now_ns >= faults->list[fault].from_ns &&
           now_ns < faults->list[fault].until_ns && faults->list[fault].frames > 0;
}

bool simulate_faults_strikes(simulate_faults_t *faults, simulate_chip_fault_t fault,
                             uint64_t now_ns) {
    if (!simulate_faults_active(faults, fault, now_ns)) {
        return false;
    }
    if (faults->list[fault].frames != SIMULATE_CHIP_FOR_EVER) {
        faults->list[fault].frames--;
    }
    return true;
}

simulate_faults_change_t simulate_faults_change(simulate_faults_t *faults,
                                                simulate_chip_fault_t fault, uint64_t now_ns) {
    bool active = simulate_faults_active(faults, fault, now_ns);
    bool was_active = faults->list[fault].begun;
    faults->list[fault].begun = active;
    if (faults->list[fault].set && now_ns >= faults->list[fault].until_ns) {
        faults->list[fault].set = false;
    }
    if (active == was_active) {
        return SIMULATE_FAULTS_STAYS;
    }
    return active ? SIMULATE_FAULTS_BEGINS : SIMULATE_FAULTS_ENDS;
}

uint64_t simulate_faults_next_ns(const simulate_faults_t *faults) {
    uint64_t next_ns = UINT64_MAX;
    for (unsigned i = 0; i < SIMULATE_CHIP_FAULTS; i++) {
        if (!faults->list[i].set || simulate_faults_of_wire((simulate_chip_fault_t)i)) {
            continue;
        }
        uint64_t change_ns =
            faults->list[i].begun ? faults->list[i].until_ns : faults->list[i].from_ns;
        next_ns = change_ns < next_ns ? change_ns : next_ns;
    }
    return next_ns;
}
