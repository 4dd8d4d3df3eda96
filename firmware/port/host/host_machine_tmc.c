// Driver chips of a simulated machine. Context: main.
//
//   tmc2209 tx=GP5 address=0 axis=X diag=GP10 load_ma=120
//   tmc2209 tx=GP5 address=1 axis=Y fault=bad-crc:3@2000 fault=stall:-400
#include "host_machine_tmc.h"

#include <string.h>

#include "hal/hal.h"
#include "host_machine_words.h"
#include "simulate_tmc_wire.h"

#define LOAD_MA 80u // friction of an axis that is well

static struct {
    simulate_tmc_t list[SIMULATE_TMC_MAX];
    unsigned count;
} drivers;

static uint64_t read_ms_ns(const char *word, const char *text, char end_char, const char **end) {
    long long ms = host_machine_number(word, text, end_char, end);
    if (ms < 0 || ms > INT32_MAX) {
        host_machine_complain("no such time:", word);
    }
    return (uint64_t)ms * 1000000u;
}

// NAME, then :NUMBER or nothing, then @FROM, @FROM-TO (ms) or nothing.
static void read_fault(simulate_faults_t *faults, const char *word, const char *text) {
    simulate_chip_fault_t fault = simulate_faults_by_name(text, strcspn(text, ":@"));
    const char *number = text + strcspn(text, ":@");
    const char *at = strchr(number, '@');
    if (fault == SIMULATE_CHIP_FAULTS) {
        host_machine_complain("no such fault:", word);
    }
    if (fault == SIMULATE_CHIP_STALL && *number != ':') {
        host_machine_complain("a stall has a place, as fault=stall:-400, not", word);
    }
    uint64_t from_ns = 0;
    uint64_t until_ns = UINT64_MAX;
    if (at != NULL) {
        bool ends = strchr(at, '-') != NULL;
        const char *behind;
        from_ns = read_ms_ns(word, at + 1, ends ? '-' : '\0', &behind);
        until_ns = ends ? read_ms_ns(word, behind, '\0', &behind) : until_ns;
    }
    simulate_faults_set(faults, fault, from_ns, until_ns);
    if (*number == ':') {
        const char *end;
        long long value = host_machine_number(word, number + 1, at != NULL ? '@' : '\0', &end);
        bool possible = value >= INT32_MIN && value <= INT32_MAX;
        if (!possible || (simulate_faults_of_wire(fault) && value < 0)) {
            host_machine_complain("out of range:", word);
        }
        simulate_faults_limit(faults, fault, (int32_t)value);
    }
}

static bool is_power_of_two(unsigned number) {
    return number > 0 && (number & (number - 1)) == 0;
}

static bool take_figures(simulate_tmc_t *tmc, const char *word) {
    int64_t skew_1000 = tmc->skew_1000;
    bool taken = host_machine_take_unsigned(word, "address", &tmc->address) ||
                 host_machine_take_unsigned(word, "microsteps", &tmc->microsteps) ||
                 host_machine_take_unsigned(word, "sense_mohm", &tmc->sense_mohm) ||
                 host_machine_take_unsigned(word, "clock_khz", &tmc->clock_khz) ||
                 host_machine_take_number(word, "skew", &skew_1000) ||
                 host_machine_take_unsigned(word, "load_ma", &tmc->load_ma);
    tmc->skew_1000 = (int32_t)skew_1000;
    return taken;
}

static void read_word(simulate_tmc_t *tmc, simulate_axis_t *(*find_axis)(const char *name),
                      const char *word) {
    const char *axis = host_machine_value(word, "axis");
    const char *fault = host_machine_value(word, "fault");
    if (axis != NULL) {
        tmc->axis = find_axis(axis);
    } else if (fault != NULL) {
        read_fault(&tmc->faults, word, fault);
    } else if (!take_figures(tmc, word) && !host_machine_take_pin(word, "tx", &tmc->tx_gpio) &&
               !host_machine_take_pin(word, "rx", &tmc->rx_gpio) &&
               !host_machine_take_pin(word, "diag", &tmc->diag_gpio) &&
               !host_machine_take_pin(word, "enable", &tmc->enable_gpio)) {
        host_machine_complain("unknown in the line of a driver:", word);
    }
}

static void check(const simulate_tmc_t *tmc) {
    if (tmc->tx_gpio == PINS_NONE) {
        host_machine_complain("a driver needs tx=", "");
    }
    if (tmc->address > 3 || (tmc->chip == 2208 && tmc->address != 0)) {
        host_machine_complain("address of a tmc2209: 0 to 3, of a tmc2208: 0", "");
    }
    if (!is_power_of_two(tmc->microsteps) || tmc->microsteps > 256) {
        host_machine_complain("microsteps: 1, 2, 4 and so on to 256", "");
    }
    if (tmc->clock_khz < 4000 || tmc->clock_khz > 16000 || tmc->sense_mohm > 1000 ||
        tmc->skew_1000 < -100 || tmc->skew_1000 > 100) {
        host_machine_complain("clock_khz 4000 to 16000, sense_mohm to 1000, skew -100 to 100", "");
    }
    if (tmc->axis != NULL && tmc->axis->mover != NULL) {
        host_machine_complain("the axis has a driver already", "");
    }
}

void host_machine_tmc(uint16_t chip, simulate_axis_t *(*find_axis)(const char *name), char *rest) {
    if (drivers.count == SIMULATE_TMC_MAX) {
        host_machine_complain("too many drivers", "");
    }
    simulate_tmc_t *tmc = &drivers.list[drivers.count++];
    simulate_tmc_init(tmc);
    tmc->chip = chip;
    tmc->load_ma = LOAD_MA;
    for (const char *word; (word = strtok_r(NULL, " \t", &rest)) != NULL;) {
        read_word(tmc, find_axis, word);
    }
    tmc->rx_gpio = tmc->rx_gpio == PINS_NONE ? tmc->tx_gpio : tmc->rx_gpio;
    check(tmc);
    if (!simulate_tmc_attach(tmc) || !simulate_tmc_wire_attach(tmc)) {
        host_machine_complain("too many parts", "");
    }
}
